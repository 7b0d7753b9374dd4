#pragma once

#include <cstddef>

#include "models/planar/planar_model.h"

namespace kingpin::planar {

/// The numbers of a model as constants of another scalar T (no derivatives with respect to them).
/// `Constants` is nothing but scalars, so it is walked as a flat array.
template <class T>
Constants<T> PromoteConstants(const Constants<double>& constants) {
  static_assert(sizeof(Constants<T>) / sizeof(T) == sizeof(Constants<double>) / sizeof(double));
  static_assert(sizeof(Constants<T>) % sizeof(T) == 0);
  Constants<T> result;
  const auto* from = reinterpret_cast<const double*>(&constants);
  auto* to = reinterpret_cast<T*>(&result);
  for (std::size_t i = 0; i < sizeof(Constants<double>) / sizeof(double); ++i) to[i] = T(from[i]);
  return result;
}

}  // namespace kingpin::planar

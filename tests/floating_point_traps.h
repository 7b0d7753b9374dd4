#pragma once

#include <cfenv>

namespace kingpin {

/// In test programs that link floating_point_traps.cpp the first operation that makes a NaN out of
/// numbers ends the program where it happens. A test whose subject is NaN holds one of these.
/// (Division by zero and overflow are not trapped: their infinities are meant.)
class WithoutTraps {
 public:
  WithoutTraps() : before_(fegetexcept()) { fedisableexcept(FE_INVALID); }
  ~WithoutTraps() {
    std::feclearexcept(FE_INVALID);
    feenableexcept(before_);
  }
  WithoutTraps(const WithoutTraps&) = delete;
  WithoutTraps& operator=(const WithoutTraps&) = delete;

 private:
  int before_;
};

}  // namespace kingpin

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kingpin::io {

/// Edit distance in which exchanging two neighbours, as in `msas` for `mass`, counts as one edit
/// (optimal string alignment), and a difference in case only counts as none.
int CalcEditDistance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, or empty when none is near enough to be a slip of the finger
/// (at most a third of the length, and at least one edit allowed).
std::string FindNearestName(std::string_view name, const std::vector<std::string>& candidates);

/// `did you mean 'mass'?`, or `known keys: a, b, c` when nothing is near; empty without
/// candidates. `what` is the plural of what is listed.
std::string SuggestName(std::string_view name, const std::vector<std::string>& candidates,
                        std::string_view what);

}  // namespace kingpin::io

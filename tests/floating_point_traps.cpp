#include <cfenv>

namespace {

// Before main: threads inherit the setting of the one that starts them.
[[maybe_unused]] const int kBefore = feenableexcept(FE_INVALID);

}  // namespace

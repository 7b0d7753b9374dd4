#include "core/io/utf8.h"

namespace kingpin::io {
namespace {

/// Bytes of the character that begins with `lead`, and what the second of them may be.
struct Form {
  std::size_t length;
  unsigned char low, high;
};

std::optional<Form> FindForm(unsigned char lead) {
  if (lead < 0x80) return Form{1, 0x80, 0xBF};
  if (lead < 0xC2) return std::nullopt;  // a byte of the middle, or an overlong form
  if (lead < 0xE0) return Form{2, 0x80, 0xBF};
  if (lead == 0xE0) return Form{3, 0xA0, 0xBF};
  if (lead == 0xED) return Form{3, 0x80, 0x9F};  // surrogates follow
  if (lead < 0xF0) return Form{3, 0x80, 0xBF};
  if (lead == 0xF0) return Form{4, 0x90, 0xBF};
  if (lead < 0xF4) return Form{4, 0x80, 0xBF};
  if (lead == 0xF4) return Form{4, 0x80, 0x8F};
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> FindInvalidUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::optional<Form> form = FindForm(static_cast<unsigned char>(text[i]));
    if (!form || i + form->length > text.size()) return i;
    for (std::size_t k = 1; k < form->length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if (byte < (k == 1 ? form->low : 0x80) || byte > (k == 1 ? form->high : 0xBF)) return i;
    }
    i += form->length;
  }
  return std::nullopt;
}

}  // namespace kingpin::io

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "optimisation/report/html.h"

namespace kingpin::report {

/// Collects the body of a report and its table of contents.
class Page {
 public:
  /// A numbered heading with an id of its own; level 2 and 3 stand in the table of contents.
  void AddHeading(int level, std::string_view text, std::string_view css = "");
  void AddParagraph(std::string_view text, std::string_view css = "");
  /// Text that is HTML already.
  void Add(std::string_view html) { body_ += html; }

  /// The whole document.
  std::string MakeDocument(std::string_view title) const;

 private:
  struct Entry {
    int level;
    std::string id;
    std::string text;
  };
  IdPool ids_;
  std::vector<Entry> contents_;
  std::string body_;
};

enum class CalloutKind { kPlain, kVerdict, kWarning };

/// A framed remark: one paragraph, or a list when there are several texts. Empty without texts.
std::string MakeCallout(CalloutKind kind, std::string_view head,
                        const std::vector<std::string>& texts);

/// A part that is folded on screen and open in print. `content` is HTML.
std::string MakeDetails(std::string_view summary, std::string_view content, bool open = false);

}  // namespace kingpin::report

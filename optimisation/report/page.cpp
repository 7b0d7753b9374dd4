#include "optimisation/report/page.h"

#include <fmt/format.h>

#include "optimisation/report/page_assets.h"

namespace kingpin::report {

void Page::AddHeading(int level, std::string_view text, std::string_view css) {
  const std::string id = ids_.MakeId(text);
  body_ += fmt::format("<h{0} id=\"{1}\"{2}>{3}</h{0}>\n", level, id,
                       css.empty() ? std::string() : fmt::format(" class=\"{}\"", css),
                       SymbolHtml(text));
  if (level <= 3) contents_.push_back({level, id, std::string(text)});
}

void Page::AddParagraph(std::string_view text, std::string_view css) {
  if (text.empty()) return;
  body_ +=
      fmt::format("<p{}>{}</p>\n", css.empty() ? std::string() : fmt::format(" class=\"{}\"", css),
                  SymbolHtml(text));
}

std::string Page::MakeDocument(std::string_view title) const {
  std::string out = "<!DOCTYPE html>\n<html lang=\"en-GB\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  // Even a mistake in this program could not make the browser fetch anything.
  out +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
  out += fmt::format("<title>{}</title>\n<style>{}</style>\n", EscapeHtml(title), GetPageStyle());
  // First of all scripts, so that an error in any later one leaves its mark.
  out +=
      "<script>window.onerror=function(m){document.documentElement.setAttribute('data-errors',"
      "String(m));};</script>\n</head>\n<body>\n<div class=\"layout\">\n<nav><b>Contents</b>\n";
  for (const Entry& entry : contents_) {
    out += fmt::format("<a class=\"l{}\" href=\"#{}\">{}</a>\n", entry.level, entry.id,
                       SymbolHtml(entry.text));
  }
  out += "</nav>\n<main>\n" + body_ + "</main>\n</div>\n";
  out += fmt::format("<script>{}</script>\n</body>\n</html>\n", GetPageScript());
  return out;
}

std::string MakeCallout(CalloutKind kind, std::string_view head,
                        const std::vector<std::string>& texts) {
  if (texts.empty()) return {};
  const char* css = kind == CalloutKind::kVerdict   ? " verdict"
                    : kind == CalloutKind::kWarning ? " warning"
                                                    : "";
  std::string out = fmt::format("<div class=\"callout{}\">", css);
  if (!head.empty()) out += fmt::format("<b class=\"head\">{}</b>", EscapeHtml(head));
  if (texts.size() == 1) {
    out += "<p>" + SymbolHtml(texts[0]) + "</p>";
  } else {
    out += "<ul>";
    for (const std::string& text : texts) out += "<li>" + SymbolHtml(text) + "</li>";
    out += "</ul>";
  }
  return out + "</div>\n";
}

std::string MakeDetails(std::string_view summary, std::string_view content, bool open) {
  return fmt::format("<details{}><summary>{}</summary>{}</details>\n", open ? " open" : "",
                     EscapeHtml(summary), content);
}

}  // namespace kingpin::report

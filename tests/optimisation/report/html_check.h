#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// A strict little reader of the HTML we write: every element closed or void, attributes quoted.
namespace kingpin::report::check {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
};

struct Document {
  std::vector<Element> elements;
  std::vector<std::string> problems;
  std::string text;  ///< outside of tags, scripts and styles

  int Count(std::string_view name) const {
    return static_cast<int>(std::count_if(elements.begin(), elements.end(),
                                          [&](const Element& e) { return e.name == name; }));
  }
};

inline Document ReadDocument(std::string_view html) {
  static const std::set<std::string> kVoid = {"meta", "br", "input", "hr", "img", "link", "col"};
  Document document;
  std::vector<std::string> open;
  size_t i = 0;
  while (i < html.size()) {
    if (html[i] != '<') {
      if (html[i] == '>') document.problems.push_back("a bare > in text");
      document.text += html[i++];
      continue;
    }
    if (html.substr(i, 2) == "<!") {
      i = html.find('>', i) + 1;
      continue;
    }
    const bool closing = html.substr(i, 2) == "</";
    i += closing ? 2 : 1;
    const size_t name_end = html.find_first_of(" />\n", i);
    if (name_end == std::string_view::npos) {
      document.problems.push_back("a tag that does not end");
      return document;
    }
    Element element;
    element.name = std::string(html.substr(i, name_end - i));
    i = name_end;
    bool self_closing = false;
    while (i < html.size() && html[i] != '>') {
      if (html[i] == ' ' || html[i] == '\n') {
        ++i;
      } else if (html[i] == '/') {
        self_closing = true;
        ++i;
      } else {
        const size_t end = html.find_first_of(" =>", i);
        const std::string attribute(html.substr(i, end - i));
        i = end;
        std::string value;
        if (html[i] == '=') {
          if (html[i + 1] != '"') {
            document.problems.push_back("attribute " + attribute + " is not quoted");
            return document;
          }
          const size_t close = html.find('"', i + 2);
          value = std::string(html.substr(i + 2, close - i - 2));
          if (value.find('<') != std::string::npos) {
            document.problems.push_back("a bare < in attribute " + attribute);
          }
          i = close + 1;
        }
        if (!element.attributes.emplace(attribute, value).second) {
          document.problems.push_back("attribute " + attribute + " twice in " + element.name);
        }
      }
    }
    ++i;
    if (closing) {
      if (open.empty() || open.back() != element.name) {
        document.problems.push_back("</" + element.name + "> closes " +
                                    (open.empty() ? "nothing" : open.back()));
        return document;
      }
      open.pop_back();
      continue;
    }
    const std::string name = element.name;
    document.elements.push_back(std::move(element));
    if (self_closing || kVoid.count(name) > 0) continue;
    if (name == "script" || name == "style") {
      const size_t end = html.find("</" + name + ">", i);
      if (end == std::string_view::npos) {
        document.problems.push_back(name + " is not closed");
        return document;
      }
      i = end + name.size() + 3;
      continue;
    }
    open.push_back(name);
  }
  for (const std::string& name : open) document.problems.push_back("<" + name + "> is not closed");
  return document;
}

}  // namespace kingpin::report::check

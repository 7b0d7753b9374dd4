#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "optimisation/report/study_report.h"
#include "tests/optimisation/report/poisoned_study.h"
#include "tests/optimisation/report/sample_study.h"

namespace kingpin::report {
namespace {

namespace fs = std::filesystem;

/// A directory of its own that goes away again.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (fs::temp_directory_path() / "kingpin-report-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool HasChromium() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

/// The page as the browser sees it after its scripts ran.
std::string DumpDom(const std::string& html) {
  const TemporaryDirectory directory;
  const fs::path page = directory.path() / "report.html";
  std::ofstream(page) << html;
  const fs::path dom = directory.path() / "dom.html";
  const std::string command =
      "timeout 150 chromium --headless --no-sandbox --disable-gpu --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync "
      "--host-resolver-rules='MAP * ~NOTFOUND' --virtual-time-budget=5000 --window-size=1400,1000 "
      "--user-data-dir='" +
      (directory.path() / "profile").string() + "' --dump-dom 'file://" + page.string() + "' >'" +
      dom.string() + "' 2>/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::ostringstream text;
  text << std::ifstream(dom).rdbuf();
  return text.str();
}

long CountOf(const std::string& text, const std::string& part) {
  long count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The opening tag of the root element, where the page leaves its marks.
std::string RootTag(const std::string& dom) {
  const size_t begin = dom.find("<html");
  return begin == std::string::npos ? "" : dom.substr(begin, dom.find('>', begin) - begin + 1);
}

TEST(Browser, DrawsTheReportWithoutErrorsAndWithoutNetwork) {
  if (!HasChromium()) GTEST_SKIP() << "chromium is not installed; the report was not drawn";
  std::string html = MakeStudyReport(sample::MakeSampleStudy());
  const long charts = CountOf(html, "<svg class=\"plot");
  // Moves the pointer over the second chart and the animation to its middle, as a reader would.
  const std::string probe =
      "<script>window.addEventListener('load',function(){"
      "const s=document.querySelectorAll('svg[data-x]')[1],b=s.getBoundingClientRect(),"
      "a=JSON.parse(s.dataset.x),p=a[0]+(0.5-a[2])/(a[3]-a[2])*(a[1]-a[0]);"
      "s.dispatchEvent(new PointerEvent('pointermove',"
      "{clientX:b.left+p*b.width/s.viewBox.baseVal.width,clientY:b.top+20}));"
      "document.documentElement.setAttribute('data-tip',document.querySelector('.tip').textContent)"
      ";"
      "const t=document.querySelector('input.time');t.value=150;t.dispatchEvent(new "
      "Event('input'));"
      "});</script></body>";
  html.replace(html.rfind("</body>"), 7, probe);
  const std::string dom = DumpDom(html);
  const std::string root = RootTag(dom);
  EXPECT_NE(root.find("data-ready=\"1\""), std::string::npos) << root;
  EXPECT_EQ(root.find("data-errors"), std::string::npos) << root;
  EXPECT_NE(root.find("data-resources=\"0\""), std::string::npos) << root;
  EXPECT_NE(root.find("data-tip=\"Time [s]: 0.500initial: "), std::string::npos) << root;
  EXPECT_NE(root.find("OPT2: "), std::string::npos) << root;
  EXPECT_GE(charts, 50);
  EXPECT_EQ(CountOf(dom, "<svg class=\"plot"), charts);
  EXPECT_NE(dom.find("Kickback card"), std::string::npos);
  EXPECT_NE(dom.find(">t = 0.3"), std::string::npos) << "the animation did not follow its slider";
  EXPECT_EQ(dom.find("NaN,"), std::string::npos);
}

TEST(Browser, MarkupInNamesStaysText) {
  if (!HasChromium()) GTEST_SKIP() << "chromium is not installed; the report was not drawn";
  const std::string dom = DumpDom(MakeStudyReport(sample::MakePoisonedStudy()));
  const std::string root = RootTag(dom);
  EXPECT_NE(root.find("data-ready=\"1\""), std::string::npos) << root;
  EXPECT_EQ(root.find("data-errors"), std::string::npos) << root;
  EXPECT_NE(root.find("data-resources=\"0\""), std::string::npos) << root;
  EXPECT_EQ(dom.find("<img"), std::string::npos);
}

}  // namespace
}  // namespace kingpin::report

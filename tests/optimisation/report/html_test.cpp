#include "optimisation/report/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::report {
namespace {

TEST(Html, EveryCharacterWithAMeaningIsEscaped) {
  EXPECT_EQ(EscapeHtml("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  EXPECT_EQ(EscapeHtml(std::string("a\x01z\x7f")), "a\uFFFDz\uFFFD");
  EXPECT_EQ(EscapeHtml("Γ ≤ 3 N·m"), "Γ ≤ 3 N·m");
}

TEST(Html, SymbolsGetSubscripts) {
  EXPECT_EQ(SymbolHtml("r_L"), "<i>r</i><sub>L</sub>");
  EXPECT_EQ(SymbolHtml("Γ_1"), "<i>Γ</i><sub>1</sub>");
  EXPECT_EQ(SymbolHtml("force F_T, then F_A,1."),
            "force <i>F</i><sub>T</sub>, then <i>F</i><sub>A,1</sub>.");
  EXPECT_EQ(SymbolHtml("x_<b>"), "x_&lt;b&gt;");
}

TEST(Html, KeysAndPathsAreNoSymbols) {
  for (const char* text : {"rack_mass", "x_1.yaml", "a_b_c", "c_segment", "_x", "x_", "r_"}) {
    EXPECT_EQ(SymbolHtml(text), text);
  }
}

TEST(Html, SubscriptsInDrawingsReturnToTheLine) {
  // The shifts, each in its own font size, add up to zero: 0.25 em of 80 % down, 0.2 em up.
  const std::string svg = SymbolSvg("F_T to F_R");
  EXPECT_NE(svg.find("dy=\"0.25em\" font-size=\"80%\">T"), std::string::npos);
  EXPECT_NE(svg.find("dy=\"-0.2em\""), std::string::npos);
  EXPECT_EQ(svg.find('_'), std::string::npos);
}

TEST(Html, UnitsAreSetAsInPrint) {
  EXPECT_EQ(PrettyUnit("N*m/rad"), "N·m/rad");
  EXPECT_EQ(PrettyUnit("mm/s^2"), "mm/s²");
  EXPECT_EQ(PrettyUnit("kg*m^-12"), "kg·m⁻¹²");
  EXPECT_EQ(PrettyUnit("m/s^1.75"), "m/s¹˙⁷⁵");
  EXPECT_EQ(PrettyUnit("x^y"), "x^y");
  EXPECT_EQ(WithUnit("Force", "kN"), "Force [kN]");
  EXPECT_EQ(WithUnit("Ratio", ""), "Ratio");
}

TEST(Html, IdsAreUniqueAndPlain) {
  IdPool ids;
  EXPECT_EQ(ids.MakeId("Kickback card"), "kickback-card");
  EXPECT_EQ(ids.MakeId("Kickback card"), "kickback-card-2");
  EXPECT_EQ(ids.MakeId("Kickback-card-2"), "kickback-card-2-2");
  EXPECT_EQ(ids.MakeId("3 kN"), "s-3-kn");
  EXPECT_EQ(ids.MakeId("Γ"), "s-");
  EXPECT_EQ(ids.MakeId("\"><script>"), "script");
}

}  // namespace
}  // namespace kingpin::report

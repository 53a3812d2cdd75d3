#include <signorini/validation/report.h>
#include <signorini/validation/report_json.h>
#include <signorini/validation/report_markdown.h>
#include <signorini/validation/report_page.h>
#include <signorini/validation/series_thinning.h>
#include <signorini/validation/worst_check.h>

#include "tests/validation/sample_report.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace signorini::validation {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A folder of this test alone, removed at its end.
class ReportWriter : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("signorini-report-" + std::to_string(getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

  [[nodiscard]] std::vector<std::string> names_in_folder() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path folder_;
};

/// The sample report, made once.
const Report& sample() {
  static const Report report = sample_report();
  return report;
}

/// The message of what a call throws; a failure if it throws nothing of this kind.
template <typename Exception, typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// A number of report.json as docs/report-schema.md says it is read.
double number(const Json& json) {
  if (json == "NaN") return kNaN;
  if (json == "Infinity") return kInfinity;
  if (json == "-Infinity") return -kInfinity;
  return json.get<double>();
}

/// Bit for bit, all NaN being one.
bool same(double left, double right) {
  if (std::isnan(left) || std::isnan(right)) return std::isnan(left) && std::isnan(right);
  return std::bit_cast<std::uint64_t>(left) == std::bit_cast<std::uint64_t>(right);
}

void expect_same(const Json& json, const std::vector<double>& values) {
  ASSERT_EQ(json.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_TRUE(same(number(json[i]), values[i])) << "at " << i;
  }
}

void expect_same(const Json& json, const Check& check) {
  EXPECT_EQ(json["name"], check.name);
  EXPECT_EQ(json["engine"], check.engine);
  EXPECT_EQ(json["reference"], check.reference);
  EXPECT_EQ(json["unit"], check.unit);
  EXPECT_EQ(json["error_kind"], check.error_kind);
  EXPECT_EQ(json["reason"], check.reason);
  EXPECT_EQ(json["verdict"], to_string(check.verdict));
  EXPECT_TRUE(same(number(json["value"]), check.value));
  EXPECT_TRUE(same(number(json["expected"]), check.expected));
  EXPECT_TRUE(same(number(json["error"]), check.error));
  EXPECT_TRUE(same(number(json["tolerance"]), check.tolerance));
}

void expect_same(const Json& json, const Plot& plot) {
  EXPECT_EQ(json["title"], plot.title);
  EXPECT_EQ(json["x_label"], plot.x_label);
  EXPECT_EQ(json["y_label"], plot.y_label);
  EXPECT_EQ(json["log_y"], plot.log_y);
  ASSERT_EQ(json["series"].size(), plot.series.size());
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    EXPECT_EQ(json["series"][i]["name"], plot.series[i].name);
    EXPECT_EQ(json["series"][i]["engine"], plot.series[i].engine);
    expect_same(json["series"][i]["x"], plot.series[i].x);
    expect_same(json["series"][i]["y"], plot.series[i].y);
  }
}

void expect_same(const Json& json, const SceneReport& scene) {
  EXPECT_EQ(json["name"], scene.name);
  EXPECT_EQ(json["title"], scene.title);
  EXPECT_EQ(json["description"], scene.description);
  EXPECT_EQ(json["source"], scene.source);
  EXPECT_EQ(json["command"], scene.command);
  EXPECT_EQ(json["settings"], Json(scene.settings));
  EXPECT_EQ(json["notices"], Json(scene.notices));
  EXPECT_EQ(json["verdict"], to_string(scene.verdict()));
  ASSERT_EQ(json["checks"].size(), scene.checks.size());
  for (std::size_t i = 0; i < scene.checks.size(); ++i) {
    expect_same(json["checks"][i], scene.checks[i]);
  }
  ASSERT_EQ(json["plots"].size(), scene.plots.size());
  for (std::size_t i = 0; i < scene.plots.size(); ++i) {
    expect_same(json["plots"][i], scene.plots[i]);
  }
  ASSERT_EQ(json["tables"].size(), scene.tables.size());
  for (std::size_t i = 0; i < scene.tables.size(); ++i) {
    EXPECT_EQ(json["tables"][i]["title"], scene.tables[i].title);
    EXPECT_EQ(json["tables"][i]["header"], Json(scene.tables[i].header));
    EXPECT_EQ(json["tables"][i]["rows"], Json(scene.tables[i].rows));
  }
}

Check passing_check() {
  Check check;
  check.name = "way";
  check.engine = "signorini";
  check.error = 1e-9;
  check.tolerance = 1e-8;
  check.verdict = Verdict::kPass;
  return check;
}

Report one_scene(const SceneReport& scene) {
  Report report;
  report.scenes = {scene};
  return report;
}

// ---- verdicts

TEST(ReportVerdict, ErrorAtToleranceIsAPassAndNaNIsAFailure) {
  EXPECT_EQ(judge(1.0, 1.0), Verdict::kPass);
  EXPECT_EQ(judge(0.0, 0.0), Verdict::kPass);
  EXPECT_EQ(judge(std::nextafter(1.0, 2.0), 1.0), Verdict::kFail);
  EXPECT_EQ(judge(kNaN, 1.0), Verdict::kFail);
  EXPECT_EQ(judge(1.0, kNaN), Verdict::kFail);
  EXPECT_EQ(judge(kInfinity, 1.0), Verdict::kFail);
}

TEST(ReportVerdict, ClaimedPassWithoutItsToleranceIsAFailure) {
  Check check = passing_check();
  EXPECT_EQ(check.judged(), Verdict::kPass);
  check.error = 2e-8;
  EXPECT_EQ(check.judged(), Verdict::kFail);
  check.error = kNaN;
  EXPECT_EQ(check.judged(), Verdict::kFail);
  check.verdict = Verdict::kInformation;
  EXPECT_EQ(check.judged(), Verdict::kInformation);
}

TEST(ReportVerdict, OneFailureFailsTheSceneAndInformationAloneJudgesNothing) {
  SceneReport scene;
  EXPECT_EQ(scene.verdict(), Verdict::kInformation);
  Check information = passing_check();
  information.verdict = Verdict::kInformation;
  scene.checks = {information};
  EXPECT_EQ(scene.verdict(), Verdict::kInformation);
  scene.checks.push_back(passing_check());
  EXPECT_EQ(scene.verdict(), Verdict::kPass);
  scene.checks.push_back(passing_check());
  scene.checks.back().verdict = Verdict::kFail;
  EXPECT_EQ(scene.verdict(), Verdict::kFail);
}

TEST(ReportVerdict, WorstCheckIsTheFailureFarthestFromItsTolerance) {
  SceneReport scene;
  EXPECT_EQ(worst_check(scene), nullptr);
  Check near = passing_check(), nearer = passing_check(), failed = passing_check();
  near.error = 0.5e-8;
  nearer.error = 0.9e-8;
  failed.error = 2e-8;
  Check information = passing_check();
  information.verdict = Verdict::kInformation;
  information.error = 1.0;
  scene.checks = {information, near, nearer};
  EXPECT_EQ(worst_check(scene), &scene.checks[2]);
  scene.checks.push_back(failed);
  EXPECT_EQ(worst_check(scene), &scene.checks[3]);
  scene.checks.push_back(failed);
  scene.checks.back().error = kNaN;
  EXPECT_EQ(worst_check(scene), &scene.checks[4]);
}

TEST(ReportVerdict, RatioOfExactValuesNeedsNoTolerance) {
  Check check = passing_check();
  check.error = 0.0;
  check.tolerance = 0.0;
  EXPECT_EQ(tolerance_ratio(check), 0.0);
  check.error = 1e-300;
  EXPECT_EQ(tolerance_ratio(check), kInfinity);
  check.error = kNaN;
  EXPECT_TRUE(std::isnan(tolerance_ratio(check)));
}

TEST(ReportVerdict, BulletsCounterpartHasTheSameName) {
  SceneReport scene;
  scene.checks = {passing_check(), passing_check(), passing_check()};
  scene.checks[1].engine = scene.checks[2].engine = "bullet";
  scene.checks[1].name = "something else";
  EXPECT_EQ(bullets_counterpart(scene, scene.checks[0]), &scene.checks[2]);
  EXPECT_EQ(bullets_counterpart(scene, scene.checks[2]), nullptr);
}

// ---- report.json

TEST(ReportJson, HoldsEveryFieldOfTheReportBitForBit) {
  const Report& report = sample();
  const Json json = Json::parse(report_json(report));
  EXPECT_EQ(json["schema"], "signorini-report");
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["command"], report.command);
  EXPECT_EQ(json["version"], report.version);
  EXPECT_EQ(json["engines"], report.engines);
  EXPECT_EQ(json["partial"], false);
  ASSERT_EQ(json["scenes"].size(), report.scenes.size());
  for (std::size_t i = 0; i < report.scenes.size(); ++i) {
    SCOPED_TRACE(report.scenes[i].name);
    expect_same(json["scenes"][i], report.scenes[i]);
  }
}

TEST(ReportJson, SummaryCountsTheScenesOfEachVerdict) {
  const Json summary = Json::parse(report_json(sample()))["summary"];
  EXPECT_EQ(summary["scenes"], 16);
  EXPECT_EQ(summary["fail"], 1);
  EXPECT_EQ(summary["information"], 2);
  EXPECT_EQ(summary["pass"], 13);
}

TEST(ReportJson, NumbersThatJsonLacksAreStrings) {
  SceneReport scene;
  scene.checks = {passing_check()};
  scene.checks[0].value = kNaN;
  scene.checks[0].expected = kInfinity;
  scene.checks[0].error = -kInfinity;
  scene.plots = {{"plot", "x", "y", false, {{"line", "signorini", {0, 1}, {kNaN, kInfinity}}}}};
  const Json json = Json::parse(report_json(one_scene(scene)))["scenes"][0];
  EXPECT_EQ(json["checks"][0]["value"], "NaN");
  EXPECT_EQ(json["checks"][0]["expected"], "Infinity");
  EXPECT_EQ(json["checks"][0]["error"], "-Infinity");
  EXPECT_EQ(json["plots"][0]["series"][0]["y"], Json({"NaN", "Infinity"}));
}

TEST(ReportJson, EngineThatWasNotRunHasNullSeconds) {
  SceneReport scene;
  scene.bullet_seconds = 0.25;
  const Json json = Json::parse(report_json(one_scene(scene)))["scenes"][0];
  EXPECT_TRUE(json["signorini_seconds"].is_null());
  EXPECT_EQ(json["bullet_seconds"], 0.25);
}

Trade two_engines(double ours, double theirs) {
  return {.error = "apex",
          .unit = "m",
          .reference = "closed form",
          .scale = 1.0,
          .duration = 5.0,
          .points = {{"ours, fine", "signorini", 0.001, ours, 8.0, 2.0},
                     {"ours, coarse", "signorini", 0.004, 0.5, 2.0, 1.0},
                     {"theirs", "bullet", 0.004, theirs, 1.0, -1.0}}};
}

TEST(Losses, AreWhereTheyAreFasterAtEqualError) {
  const std::vector<Loss> lost = losses(two_engines(1e-3, 2e-3));
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].theirs, 2u);
  EXPECT_TRUE(lost[0].reached);
  EXPECT_EQ(lost[0].ours, 0u);
  EXPECT_EQ(lost[0].factor, 8.0);
  // At their error our coarse run is good enough, and it is cheaper than our fine one.
  EXPECT_EQ(losses(two_engines(1e-3, 0.6))[0].ours, 1u);
}

TEST(Losses, OfAnErrorThatNoneOfOursReachesAreInfinite) {
  const std::vector<Loss> lost = losses(two_engines(1e-3, 1e-4));
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_FALSE(lost[0].reached);
  EXPECT_EQ(lost[0].factor, kInfinity);
}

TEST(Losses, ErrorsThatNobodySeesAreEqual) {
  const std::vector<Loss> lost = losses(two_engines(1e-10, 0.0));
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_TRUE(lost[0].reached);
  EXPECT_EQ(lost[0].factor, 8.0);
}

TEST(Losses, WrongAnswersAndNoAnswersWinNothing) {
  EXPECT_TRUE(losses(two_engines(1e-3, 1.0)).empty());
  EXPECT_TRUE(losses(two_engines(1e-3, kNaN)).empty());
  EXPECT_TRUE(losses(Trade{}).empty());
  Trade faster = two_engines(1e-3, 2e-3);
  faster.points[0].whole_seconds = 0.5;
  EXPECT_TRUE(losses(faster).empty());
}

TEST(ReportJson, TradeHoldsItsPointsAndLosses) {
  SceneReport scene;
  scene.trade = two_engines(kNaN, 2e-3);
  const Json json = Json::parse(report_json(one_scene(scene)))["scenes"][0]["trade"];
  EXPECT_EQ(json["points"][0]["error"], "NaN");
  EXPECT_TRUE(json["points"][2]["solver_seconds"].is_null());
  EXPECT_TRUE(json["losses"][0]["ours"].is_null());
  EXPECT_EQ(json["losses"][0]["factor"], "Infinity");
  EXPECT_TRUE(Json::parse(report_json(one_scene({})))["scenes"][0]["trade"].is_null());
}

TEST(ReportJson, ClaimedPassWithoutItsToleranceIsWrittenAsFail) {
  SceneReport scene;
  scene.checks = {passing_check()};
  scene.checks[0].error = 1.0;
  const Json json = Json::parse(report_json(one_scene(scene)))["scenes"][0];
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["checks"][0]["verdict"], "fail");
}

TEST(ReportJson, BytesThatAreNoUtf8AreReplaced) {
  SceneReport scene;
  scene.title =
      "a\xff"
      "b";
  const Json json = Json::parse(report_json(one_scene(scene)));
  EXPECT_EQ(json["scenes"][0]["title"],
            "a\uFFFD"
            "b");
}

TEST(ReportJson, PageTextHoldsNoOpeningBracketAndTheSameTexts) {
  const Report& report = sample();
  const std::string text = report_page_json(report);
  EXPECT_EQ(text.find('<'), std::string::npos);
  const Json json = Json::parse(text);
  ASSERT_EQ(json["scenes"].size(), report.scenes.size());
  EXPECT_EQ(json["scenes"].back()["title"], report.scenes.back().title);
  EXPECT_EQ(json["scenes"].back()["description"], report.scenes.back().description);
}

TEST(ReportJson, PageLinesAreThinnedAndSayHowManyPointsTheyHad) {
  SceneReport scene;
  Series line{"line", "signorini", {}, {}};
  for (int i = 0; i < 5001; ++i) {
    line.x.push_back(i / 3.0);
    line.y.push_back(std::sin(i / 100.0));
  }
  scene.plots = {{"plot", "x", "y", false, {line}}};
  const Json json = Json::parse(report_page_json(one_scene(scene)));
  const Json& series = json["scenes"][0]["plots"][0]["series"][0];
  EXPECT_EQ(series["points"], 5001);
  EXPECT_LE(series["x"].size(), 900U);
  EXPECT_EQ(series["x"].size(), series["y"].size());
  EXPECT_EQ(series["x"].back().dump(), "1666.667");
}

// ---- thinning

Series sine(int points, double phase) {
  Series line{"line", "signorini", {}, {}};
  for (int i = 0; i < points; ++i) {
    line.x.push_back(i);
    line.y.push_back(std::sin(0.9 * i + phase));
  }
  return line;
}

TEST(SeriesThinning, ShortLinesAreKeptWhole) {
  const Series line{"line", "bullet", {0, 1, 2, 3, 4}, {5, kNaN, 7, 8, 9}};
  const std::vector<Series> result = thinned({line, Series{}}, 5);
  ASSERT_EQ(result.size(), 2U);
  EXPECT_EQ(result[0].name, "line");
  EXPECT_EQ(result[0].engine, "bullet");
  EXPECT_EQ(result[0].x, line.x);
  EXPECT_TRUE(result[1].x.empty());
  EXPECT_TRUE(thinned({}, 5).empty());
}

TEST(SeriesThinning, SinglePeakGapAndEndsSurvive) {
  Series line{"line", "signorini", {}, {}};
  for (int i = 0; i < 10000; ++i) {
    line.x.push_back(i);
    line.y.push_back(0.0);
  }
  line.y[4321] = 1.0;
  line.y[8765] = -1.0;
  line.y[7000] = kNaN;
  const Series result = thinned({line}, 100)[0];
  EXPECT_LE(result.x.size(), 100U);
  EXPECT_TRUE(std::is_sorted(result.x.begin(), result.x.end()));
  EXPECT_EQ(result.x.front(), 0.0);
  EXPECT_EQ(result.x.back(), 9999.0);
  for (const int kept : {4321, 8765, 7000}) {
    const auto at = std::find(result.x.begin(), result.x.end(), kept);
    ASSERT_NE(at, result.x.end());
    EXPECT_TRUE(same(result.y[at - result.x.begin()], line.y[kept]));
  }
}

TEST(SeriesThinning, LinesWithEqualXKeepTheSamePointsAndOthersTheirOwn) {
  const std::vector<Series> lines = {sine(5000, 0.0), sine(4000, 0.0), sine(5000, 1.0)};
  const std::vector<Series> result = thinned(lines, 200);
  EXPECT_EQ(result[0].x, result[2].x);
  EXPECT_EQ(result[1].x.back(), 3999.0);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    EXPECT_LE(result[line].x.size(), 200U);
    EXPECT_GE(result[line].x.size(), 100U) << "thinner than it had to be";
    for (std::size_t i = 0; i < result[line].x.size(); ++i) {
      const auto original = static_cast<std::size_t>(result[line].x[i]);
      EXPECT_EQ(result[line].y[i], lines[line].y[original]);
    }
  }
}

// ---- report.md

TEST(ReportMarkdown, EscapesWhatTablesAndHtmlWouldRead) {
  EXPECT_EQ(markdown_escaped("a|b"), "a\\|b");
  EXPECT_EQ(markdown_escaped("a\nb"), "a b");
  EXPECT_EQ(markdown_escaped("<b> `c` *d* \\"), "\\<b\\> \\`c\\` \\*d\\* \\\\");
  EXPECT_EQ(markdown_fenced("run ``` now"), "````\nrun ``` now\n````\n");
}

TEST(ReportMarkdown, EveryRowOfATableHasAsManyCellsAsItsHeader) {
  std::istringstream lines(report_markdown(sample(), ""));
  std::size_t bars_of_table = 0;
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    std::size_t bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\\') {
        ++i;
      } else if (line[i] == '|') {
        ++bars;
      }
    }
    if (line.empty() || line[0] != '|') {
      bars_of_table = 0;
      continue;
    }
    if (bars_of_table == 0) bars_of_table = bars;
    EXPECT_EQ(bars, bars_of_table) << line;
    ++rows;
  }
  EXPECT_GT(rows, 16);
}

TEST(ReportMarkdown, FailedScenesStandFirst) {
  const std::string text = report_markdown(sample(), "");
  EXPECT_NE(text.find("16 scenes: **1 failed**, 13 passed, 2 for information only."),
            std::string::npos);
  EXPECT_LT(text.find("| **FAIL** | stack-of-5-boxes"), text.find("| pass | free-flight"));
}

TEST(ReportMarkdown, SaysThatTheRunIsPartialAndWhyThereIsNoPage) {
  Report report = sample();
  EXPECT_EQ(report_markdown(report, "").find("PARTIAL"), std::string::npos);
  report.partial = true;
  const std::string text = report_markdown(report, "this build had no node");
  EXPECT_NE(text.find("PARTIAL"), std::string::npos);
  EXPECT_NE(text.find("report.html was not made: this build had no node."), std::string::npos);
}

// ---- report.html

TEST(ReportPage, DataStandsWhereThePlaceholderWas) {
  const std::string page = "<script>" + std::string(kReportPlaceholder) + "</script>";
  EXPECT_EQ(report_page(page, "{}"), "<script>{}</script>");
  EXPECT_THROW(static_cast<void>(report_page("<script></script>", "{}")), std::logic_error);
  EXPECT_THROW(static_cast<void>(report_page(page + page, "{}")), std::logic_error);
}

TEST(ReportPage, BuiltTemplateLoadsNothingFromElsewhere) {
  const std::string page(report_page_template());
  if (page.empty()) GTEST_SKIP() << report_page_absent_because();
  // The script inside may speak of sources; what stands before it may not, and it has none itself.
  EXPECT_EQ(page.substr(0, page.find("<script>")).find("src="), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

// ---- files

TEST_F(ReportWriter, MakesTheFolderAndNamesWhatItWrote) {
  folder_ /= "of/two";
  const std::vector<std::string> written = write_report(sample(), folder_.string());
  const bool has_page = report_page_absent_because().empty();
  ASSERT_EQ(written.size(), has_page ? 3U : 2U);
  EXPECT_EQ(written[0], (folder_ / "report.json").string());
  EXPECT_EQ(written[1], (folder_ / "report.md").string());
  EXPECT_EQ(names_in_folder().size(), written.size());
  EXPECT_EQ(read("report.json"), report_json(sample()));
  EXPECT_EQ(read("report.md"), report_markdown(sample(), report_page_absent_because()));
  folder_ = folder_.parent_path().parent_path();
}

TEST_F(ReportWriter, SceneFilesStandBesideTheReportUnderSafeNames) {
  Report report;
  report.scenes.resize(2);
  report.scenes[0].name = "ball";
  report.scenes[0].text = "<sdf/>";
  report.scenes[1].name = "../a b";
  report.scenes[1].text = "<robot/>";
  write_report(report, folder_.string());
  EXPECT_EQ(read("scenes/01-ball.sdf"), "<sdf/>");
  EXPECT_EQ(read("scenes/02-.._a_b.sdf"), "<robot/>");
  EXPECT_EQ(Json::parse(read("report.json"))["scenes"][1]["file"], "scenes/02-.._a_b.sdf");
}

TEST_F(ReportWriter, PageOfTheSampleIsOneSmallFileWithAllTexts) {
  write_report(sample(), folder_.string());
  if (!report_page_absent_because().empty()) GTEST_SKIP() << report_page_absent_because();
  const std::string page = read("report.html");
  EXPECT_NE(page.find(report_page_json(sample())), std::string::npos);
  // 16 scenes; the default set is a small multiple of that and must stay far below 10 MB.
  EXPECT_LT(page.size(), 2'000'000U);
}

TEST_F(ReportWriter, ReplacesAnEarlierReport) {
  write_report(sample(), folder_.string());
  write_report(Report{}, folder_.string());
  EXPECT_EQ(Json::parse(read("report.json"))["scenes"].size(), 0U);
}

TEST_F(ReportWriter, FolderThatCannotBeMadeIsNamed) {
  std::ofstream(folder_) << "a file";
  const std::string inside = (folder_ / "report").string();
  const std::string message =
      message_of<std::runtime_error>([&] { write_report(Report{}, inside); });
  EXPECT_NE(message.find(inside), std::string::npos) << message;
}

TEST_F(ReportWriter, FolderWithoutWriteAccessIsNamedAndLeftEmpty) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directories(folder_);
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  const std::string message =
      message_of<std::runtime_error>([&] { write_report(Report{}, folder_.string()); });
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_NE(message.find((folder_ / "report.json").string()), std::string::npos) << message;
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ReportWriter, FileThatCannotBeReplacedIsNamedAndNothingIsLeftBeside) {
  fs::create_directories(folder_ / "report.json" / "a folder with something in it");
  const std::string message =
      message_of<std::runtime_error>([&] { write_report(Report{}, folder_.string()); });
  EXPECT_NE(message.find((folder_ / "report.json").string()), std::string::npos) << message;
  EXPECT_EQ(names_in_folder(), std::vector<std::string>{"report.json"});
}

TEST_F(ReportWriter, FullDiskLeavesTheEarlierReportAsItWas) {
  write_report(Report{}, folder_.string());
  const std::vector<std::string> names_before = names_in_folder();
  const std::string before = read("report.json");

  // A file may grow to 64 bytes: what a full disk does, in this process alone.
  const auto earlier_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit earlier_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &earlier_limit), 0);
  rlimit small = earlier_limit;
  small.rlim_cur = 64;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_report(sample(), folder_.string());
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &earlier_limit), 0);
  std::signal(SIGXFSZ, earlier_handler);

  EXPECT_NE(message.find((folder_ / "report.json").string()), std::string::npos) << message;
  EXPECT_EQ(read("report.json"), before);
  EXPECT_EQ(names_in_folder(), names_before);
}

TEST_F(ReportWriter, SeriesOfUnequalLengthsIsRefusedBeforeAnythingIsWritten) {
  SceneReport scene;
  scene.name = "scene";
  scene.plots = {{"plot", "x", "y", false, {{"line", "signorini", {0, 1}, {0}}}}};
  const std::string message =
      message_of<std::invalid_argument>([&] { write_report(one_scene(scene), folder_.string()); });
  EXPECT_EQ(message,
            "scene 'scene': plot 'plot', series 'line': x has 2 points, y has 1; they must be as "
            "many");
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(ReportWriter, SeriesWhoseXFallsOrIsNaNIsRefused) {
  SceneReport scene;
  scene.plots = {{"plot", "x", "y", false, {{"line", "signorini", {1, 0.5}, {0, 0}}}}};
  EXPECT_NE(message_of<std::invalid_argument>([&] {
              write_report(one_scene(scene), folder_.string());
            }).find("x[1] = 0.5 must be at least x[0] = 1"),
            std::string::npos);
  scene.plots[0].series[0].x = {0, kNaN};
  EXPECT_NE(message_of<std::invalid_argument>([&] {
              write_report(one_scene(scene), folder_.string());
            }).find("x[1] = nan must be finite"),
            std::string::npos);
}

TEST_F(ReportWriter, TableRowOfAnotherLengthThanItsHeaderIsRefused) {
  SceneReport scene;
  scene.tables = {{"table", {"a", "b"}, {{"1", "2"}, {"3"}}}};
  const std::string message =
      message_of<std::invalid_argument>([&] { write_report(one_scene(scene), folder_.string()); });
  EXPECT_NE(message.find("table 'table': rows[1] has 1 cells, header has 2"), std::string::npos);
}

}  // namespace
}  // namespace signorini::validation

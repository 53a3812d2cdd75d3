#include "tests/tools/four_ranks.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace {

struct Outcome {
  int exit_code;
  std::string output;  ///< stdout and stderr
};

Outcome shell(const std::string& command) {
  std::FILE* pipe = popen(("exec 2>&1; " + command).c_str(), "r");
  std::string output;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("signorini-validate-") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Outcome run(const std::string& arguments) {
    return shell(SIGNORINI_VALIDATE " --out '" + out() + "' " + arguments);
  }
  std::string out() const { return (folder_ / "report").string(); }
  nlohmann::json report() const {
    std::ifstream file(out() + "/report.json");
    return nlohmann::json::parse(file);
  }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path) << text;
    return path;
  }

  std::filesystem::path folder_;
};

const char* const kBallOnPlane =
    "<sdf version='1.9'><world name='w'><model name='ball'><pose>0 0 0.6 0 0 0</pose>"
    "<link name='l'><inertial><mass>1</mass></inertial><collision name='c'><geometry><sphere>"
    "<radius>0.5</radius></sphere></geometry></collision></link></model>"
    "<model name='ground'><static>true</static><link name='l'><collision name='c'><geometry>"
    "<plane/></geometry></collision></link></model></world></sdf>";

TEST_F(Program, DropInScenesRunBulletWithOurSolverInside) {
  // While the vehicle falls and lands, its hinges are pulled apart whoever solves: after 0.5 s
  // Bullet's sequential impulses have them 0.0556 m apart (SI10 0.0557, SI1000 0.0556), ours
  // 0.0566; after 1 s 8e-5 and 2e-5.
  // BulletConstraintSolver.VehicleLandsWithItsJointsAsInBulletsOwn.
  const Outcome outcome = run("drop-in-stack drop-in-vehicle --duration 1");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  ASSERT_EQ(report()["scenes"].size(), 2u);
  EXPECT_EQ(report()["scenes"][0]["name"], "drop-in-stack");
  EXPECT_EQ(report()["scenes"][0]["verdict"], "pass");
}

TEST_F(Program, GoodSceneEndsWithZeroAndAReport) {
  const std::string scene = write("ball.sdf", kBallOnPlane);
  const Outcome outcome = run("--duration 0.2 '" + scene + "'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(out() + "/report.md"));
  EXPECT_FALSE(report()["partial"].get<bool>());
  EXPECT_EQ(outcome.output.find('\r'), std::string::npos) << "no control codes in a log";
  EXPECT_EQ(outcome.output.find('\x1b'), std::string::npos);
}

TEST_F(Program, FailedCheckEndsWithOne) {
  // A ball between two opposite walls: no step has a solution with e = 1.
  const std::string wall =
      "<collision name='c'><geometry><plane><normal>%s</normal></plane></geometry>"
      "<surface><bounce><restitution_coefficient>1</restitution_coefficient>"
      "</bounce></surface></collision>";
  const auto model = [&](const std::string& name, const std::string& x, const std::string& normal) {
    std::string text = wall;
    text.replace(text.find("%s"), 2, normal);
    return "<model name='" + name + "'><static>true</static><pose>" + x + " 0 0 0 0 0</pose>" +
           "<link name='l'>" + text + "</link></model>";
  };
  const std::string scene = write(
      "walls.sdf",
      "<sdf version='1.9' xmlns:signorini='urn:signorini'><world name='w'><gravity>0 0 0</gravity>"
      "<model name='ball'><link name='l'><inertial><mass>1</mass></inertial>"
      "<signorini:linear_velocity>1 0 0</signorini:linear_velocity>"
      "<collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry>"
      "<surface><bounce><restitution_coefficient>1</restitution_coefficient></bounce></surface>"
      "</collision></link></model>" +
          model("left", "-0.5", "1 0 0") + model("right", "0.5", "-1 0 0") + "</world></sdf>");
  const Outcome outcome = run("--duration 0.01 --engine signorini '" + scene + "'");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("failed: steps whose contact problem was not solved"),
            std::string::npos)
      << outcome.output;
}

TEST_F(Program, BadUsageEndsWith64) {
  EXPECT_EQ(run("--no-such-option").exit_code, 64);
  EXPECT_EQ(run("--engine ode").exit_code, 64);
  EXPECT_EQ(run("--duration -1").exit_code, 64);
}

TEST_F(Program, BadSceneEndsWith65AndWritesNothing) {
  const Outcome missing = run("/no/such/file.sdf");
  EXPECT_EQ(missing.exit_code, 65);
  EXPECT_NE(missing.output.find("/no/such/file.sdf: cannot be read"), std::string::npos);
  std::string heightmap = kBallOnPlane;
  heightmap.replace(heightmap.find("<sphere>"), 8, "<heightmap>");
  heightmap.replace(heightmap.find("</sphere>"), 9, "</heightmap>");
  const std::string scene = write("heightmap.sdf", heightmap);
  const Outcome unsupported = run("'" + scene + "'");
  EXPECT_EQ(unsupported.exit_code, 65);
  EXPECT_NE(unsupported.output.find("<heightmap> is not supported"), std::string::npos);
  EXPECT_NE(unsupported.output.find("model 'ball', link 'l', collision 'c'"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_EQ(run("--skip-unsupported --duration 0.01 '" + scene + "'").exit_code, 0);
}

TEST_F(Program, BuiltinSceneByName) {
  const Outcome outcome = run("wedge");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(report()["scenes"].size(), 1u);
  EXPECT_EQ(report()["scenes"][0]["command"], "signorini-validate wedge");
}

TEST_F(Program, ReportIsMadeAgainFromItsFolderToTheBit) {
  const std::string scene = write("ball.sdf", kBallOnPlane);
  ASSERT_EQ(run("--duration 0.2 wedge ball-drop-e0.5 '" + scene + "'").exit_code, 0);
  std::filesystem::remove(scene);
  const std::string again = SIGNORINI_VALIDATE " --verify '" + out() + "'";
  const Outcome same = shell(again);
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_NE(same.output.find("3 scenes"), std::string::npos) << same.output;
  EXPECT_NE(same.output.find(" 0 differences"), std::string::npos) << same.output;

  // One digit of one number, and a scene that is not the one that was run.
  nlohmann::json report = this->report();
  report["scenes"][0]["checks"][0]["value"] = 0.125;
  std::ofstream(out() + "/report.json") << report;
  const Outcome other = shell(again);
  EXPECT_EQ(other.exit_code, 1) << other.output;
  EXPECT_NE(other.output.find("scenes[0].checks[0].value: 0.125, again"), std::string::npos)
      << other.output;
  std::filesystem::remove(out() + "/scenes/03-ball.sdf");
  EXPECT_EQ(shell(again).exit_code, 65);
  report["arguments"]["engine"] = 5;
  std::ofstream(out() + "/report.json") << report;
  const Outcome odd = shell(again);
  EXPECT_EQ(odd.exit_code, 65) << odd.output;
  EXPECT_NE(odd.output.find("report.json: "), std::string::npos) << odd.output;
  std::ofstream(out() + "/report.json") << "{}";
  EXPECT_EQ(shell(again).exit_code, 65);
}

/// A report without what times are.
std::string without_times(nlohmann::json report) {
  report.erase("command");
  report.erase("jobs");
  for (nlohmann::json& scene : report["scenes"]) {
    scene.erase("command");
    for (const char* engine : {"signorini", "bullet"}) {
      scene.erase(std::string(engine) + "_seconds");
      scene.erase(std::string(engine) + "_solver_seconds");
    }
    if (scene["trade"].is_null()) continue;
    scene["trade"].erase("losses");
    for (nlohmann::json& point : scene["trade"]["points"]) {
      point.erase("whole_seconds");
      point.erase("solver_seconds");
    }
  }
  return report.dump();
}

TEST_F(Program, AListOfJobsGivesTheReportThatOneProcessGives) {
  const std::string scene = write("ball.sdf", kBallOnPlane);
  const std::string scenes = "--duration 0.2 wedge slope-stick newtons-cradle '" + scene + "'";
  ASSERT_EQ(run(scenes).exit_code, 0);
  const std::string serial = without_times(report());
  EXPECT_EQ(report()["jobs"], "");
  const Outcome processes = run("--jobs 3 " + scenes);
  EXPECT_EQ(processes.exit_code, 0) << processes.output;
  EXPECT_EQ(without_times(report()), serial);
  EXPECT_NE(report()["jobs"].get<std::string>().find("TIMES ARE OF A SHARED MACHINE"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out() + "/jobs"));
  EXPECT_TRUE(std::filesystem::exists(out() + "/scenes/04-ball.sdf"));
#ifdef SIGNORINI_MPIRUN
  const Outcome ranks =
      shell(signorini::kFourRanks + " " SIGNORINI_VALIDATE " --out '" + out() + "' " + scenes);
  EXPECT_EQ(ranks.exit_code, 0) << ranks.output;
  EXPECT_EQ(without_times(report()), serial);
#endif
}

TEST_F(Program, AnInterruptedListLeavesAPartialReportAndGoesOn) {
  const std::string quick = write("quick.sdf", kBallOnPlane);
  const std::string slow = write("slow.sdf", kBallOnPlane);
  // The first scene takes three steps, the second would run for hours.
  std::string text = kBallOnPlane;
  text.replace(text.find("<model"), 0,
               "<physics type='ode'><max_step_size>1e3</max_step_size></physics>");
  std::ofstream(quick) << text;
  const std::string jobs = out() + "/jobs";
  const Outcome outcome = shell(
      SIGNORINI_VALIDATE " --jobs 2 --out '" + out() + "' --engine signorini --duration 3e3 '" +
      quick + "' '" + slow + "' & pid=$!; until ls '" + jobs +
      "'/*.job >/dev/null 2>&1 || ! kill -0 $pid; do sleep 0.05; done; kill -INT $pid; "
      "wait $pid");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.output;
  EXPECT_TRUE(report()["partial"].get<bool>());
  ASSERT_EQ(report()["scenes"].size(), 1U);
  EXPECT_EQ(report()["scenes"][0]["name"], "quick");
  EXPECT_TRUE(std::filesystem::exists(jobs)) << "to go on from";
}

TEST_F(Program, ListNamesTheBuiltinScenes) {
  const Outcome outcome = run("--list");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* name : {"wedge", "ball-drop-e0.5", "torque-free-spin", "stack-of-5"}) {
    EXPECT_NE(outcome.output.find(name), std::string::npos) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Program, InterruptLeavesAValidPartialReport) {
  // The first scene takes ten steps, the second would run for hours.
  const std::string quick = write(
      "quick.sdf",
      "<sdf version='1.9'><world name='w'><physics type='ode'><max_step_size>1e4</max_step_size>"
      "</physics><model name='m'><link name='l'/></model></world></sdf>");
  const std::string slow = write("slow.sdf", kBallOnPlane);
  // Interrupted once the first scene is done, however slow the machine is.
  const std::string log = (folder_ / "log").string();
  const Outcome outcome =
      shell(SIGNORINI_VALIDATE " --out '" + out() + "' --engine signorini --duration 1e5 '" +
            quick + "' '" + slow + "' > '" + log + "' & pid=$!; until grep -q '1/2' '" + log +
            "' || ! kill -0 $pid; do sleep 0.05; done; kill -INT $pid; "
            "wait $pid");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.output;
  const nlohmann::json written = report();
  EXPECT_TRUE(written["partial"].get<bool>());
  // The second is there as far as it came, or not at all if it had not begun.
  ASSERT_GE(written["scenes"].size(), 1u);
  EXPECT_EQ(written["scenes"][0]["notices"].dump().find("stopped"), std::string::npos);
  if (written["scenes"].size() > 1) {
    EXPECT_NE(written["scenes"][1]["notices"].dump().find("stopped: the run of signorini ended"),
              std::string::npos);
  }
}

TEST_F(Program, ATerminalShowsStepsAndTimeLeftAndALogDoesNot) {
  if (shell("command -v script").exit_code != 0) GTEST_SKIP() << "no program 'script'";
  const std::string scene = write("ball.sdf", kBallOnPlane);
  // Stopped once the time left is shown.
  const std::string log = (folder_ / "log").string();
  const std::string commands = write(
      "commands.sh", std::string(SIGNORINI_VALIDATE) + " --out '" + out() +
                         "' --engine signorini --duration 1e5 '" + scene +
                         "' & pid=$!\nuntil grep -q ' left' '" + log +
                         "' || ! kill -0 $pid; do sleep 0.05; done\nkill -INT $pid\nwait $pid\n");
  const Outcome outcome = shell("script -qfec \"sh '" + commands + "'\" '" + log + "'");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.output;
  EXPECT_NE(outcome.output.find("signorini "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find(" steps, "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find(" left"), std::string::npos) << outcome.output;
  EXPECT_TRUE(report()["partial"].get<bool>());
}

}  // namespace

// glocal figures.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <optional>

#include "app/result_lines.hpp"
#include "app/room.hpp"
#include "app/svg.hpp"
#include "glocal/pose2.hpp"

namespace glocal::test::figures_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* odd_name = "it's \"1\" $x$ & <script>";

/// For the shell.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

bool has_matplotlib() {
  static const bool has =
      std::system("python3 -c 'import matplotlib' 2>&- || /usr/bin/python3 -c 'import matplotlib' 2>&-") == 0;
  return has;
}

class Figures : public Room {
 protected:
  Figures() { write_experiment("trials: {whole: true}\n"); }

  void run_whole(const std::string& out, const std::string& options = "") const {
    good(run_room(out, "--quiet " + options));
  }

  [[nodiscard]] Answer figures(const std::string& folder, const std::string& out,
                               const std::string& options = "") const {
    return run("figures " + quoted(file(folder)) + " --out " + quoted(file(out)) + " " + options);
  }

  [[nodiscard]] std::string program(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(file(name), fs::perms::owner_all);
    return file(name);
  }

  /// An option for a Python that draws nothing, and notes what it is called with.
  [[nodiscard]] std::string pretended_python() const {
    return " --python " + program("pretended", "[ \"$1\" = -c ] || printf '%s\\n' \"$@\" >" + file("called"));
  }

  [[nodiscard]] std::vector<Json> steps(const std::string& folder) const {
    return json_lines(file(folder + "/steps.jsonl"));
  }

  void write_steps(const std::string& folder, const std::vector<Json>& all) const {
    std::ofstream out(file(folder + "/steps.jsonl"));
    for (const Json& step : all) out << step.dump() << "\n";
  }
};

TEST_F(Figures, HandsTheFoldersToAScript) {
  run_whole("a");
  fs::rename(file("a"), file(odd_name));
  good(figures(odd_name, "b 'c", pretended_python()));
  EXPECT_THAT(content(file("b 'c/figures.py")), StartsWith("#!/usr/bin/env python3\n"));
  EXPECT_EQ(content(file("called")), file("b 'c/figures.py") + "\n--out\n" + file("b 'c") +
                                         "\n--trial\n0\n--\n" + file(odd_name) + "\n");
}

TEST_F(Figures, KeepsAScriptThatWasChanged) {
  run_whole("a");
  good(figures("a", "b", pretended_python()));
  const std::string script = content("b/figures.py");
  EXPECT_EQ(figures("a", "b", pretended_python()).err, "");
  std::ofstream("b/figures.py") << "changed\n";
  const Answer kept = good(figures("a", "b", pretended_python()));
  EXPECT_THAT(kept.err, HasSubstr("drawn with this as it has been changed; --force writes it anew"));
  EXPECT_EQ(content("b/figures.py"), "changed\n");
  good(figures("a", "b", "--force" + pretended_python()));
  EXPECT_EQ(content("b/figures.py"), script);
}

TEST_F(Figures, WritesIntoNoForeignFolderUnlessForced) {
  run_whole("a");
  fs::create_directory("thesis");
  std::ofstream("thesis/fig3.pdf") << "unfinished\n";
  EXPECT_THAT(refusal(figures("a", "thesis", pretended_python())),
              HasSubstr("thesis: error: holds other files, and no figures.py"));
  EXPECT_FALSE(fs::exists("thesis/figures.py"));
  good(figures("a", "thesis", "--force" + pretended_python()));
  EXPECT_TRUE(fs::exists("thesis/figures.py"));
  EXPECT_THAT(figures("a", "room.yaml", pretended_python()).err, HasSubstr("room.yaml: error: is no folder"));
}

TEST_F(Figures, ReportsTheFaultsOfAllFolders) {
  for (const char* folder : {"cut_line", "cut_steps", "cut_clouds"}) run_whole(folder);
  run_whole("no_steps", "--set output.steps=false");
  fs::resize_file("cut_line/steps.jsonl", fs::file_size("cut_line/steps.jsonl") - 10);
  const std::size_t n = steps("cut_steps").size();
  write_steps("cut_steps", {steps("cut_steps").front()});
  for (const char* cloud : {"global.pcd", "trial_0000/step_0003.pcd"})
    fs::resize_file(fs::path("cut_clouds/maps") / cloud, 300);
  fs::create_directory("foreign");
  std::string folders;
  for (const std::string folder : {"cut_line", "cut_steps", "cut_clouds", "no_steps", "foreign", "missing"})
    folders += " " + folder;

  const Answer answer = run("figures" + folders + " --out b" + pretended_python());
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_EQ(answer.out, "");
  const std::string count = std::to_string(n);
  const std::string declared = json("cut_steps/trials.jsonl")["steps"].dump();
  for (const std::string& fault :
       {"cut_line/steps.jsonl:" + count + ": error: is no line of results",
        "cut_steps/steps.jsonl:1: error: ends here with 1 of the " + declared + " steps of trial 0; run",
        std::string("cut_clouds/maps/global.pcd: error: has 130 bytes of points where"),
        std::string("cut_clouds/maps/trial_0000/step_0003.pcd: error: has 132 bytes of points where"),
        std::string("no_steps/steps.jsonl: error: is not there; run the experiment again with --set "
                    "output.steps=true"),
        std::string("foreign: error: holds no results"), std::string("missing: error: is no folder"),
        std::string("\n7 errors\n")}) {
    EXPECT_THAT(answer.err, HasSubstr(fault));
  }
  EXPECT_FALSE(fs::exists("b"));
  EXPECT_FALSE(fs::exists("called"));
}

TEST_F(Figures, RefusesATrialThatIsNotThere) {
  run_whole("a");
  EXPECT_THAT(refusal(figures("a", "b", "--trial 1" + pretended_python())),
              HasSubstr("a/trials.jsonl: error: has no trial 1; choose one from 0 to 0"));
  EXPECT_EQ(figures("a", "b", "--trial -1" + pretended_python()).exit_code, 2);
  EXPECT_FALSE(fs::exists("b"));
}

TEST_F(Figures, RefusesStepsOfAnotherKind) {
  run_whole("a");
  std::vector<Json> changed = steps("a");
  changed[2]["best"][0]["pose"]["x"] = "far";
  write_steps("a", changed);
  EXPECT_THAT(figures("a", "b", pretended_python()).err, HasSubstr("a/steps.jsonl:3: error: is no line"));
  changed.erase(changed.begin() + 2);
  write_steps("a", changed);
  EXPECT_THAT(figures("a", "b", pretended_python()).err, HasSubstr("where step 2 belongs"));
  EXPECT_FALSE(fs::exists("b"));
}

TEST_F(Figures, SayWhereToGetMatplotlib) {
  run_whole("a");
  EXPECT_THAT(refusal(figures("a", "b", "--python false"), 1),
              AllOf(HasSubstr("false: cannot import matplotlib"), HasSubstr("package python3-matplotlib")));
  EXPECT_THAT(refusal(figures("a", "b", "--python " + file("python")), 1),
              HasSubstr(file("python") + ": No such file or directory"));
  EXPECT_FALSE(fs::exists("b"));
}

TEST_F(Figures, TakeThePythonOfPathFirst) {
  run_whole("a");
  fs::create_directory("bin");
  fs::rename(program("python3", "echo called"), "bin/python3");
  const std::string path = std::getenv("PATH");
  setenv("PATH", (file("bin") + ":" + path).c_str(), 1);
  const Answer answer = figures("a", "b");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(good(answer).out, "called\n");
}

TEST_F(Figures, FailWithTheScript) {
  run_whole("a");
  const std::string failing = program("failing", "[ \"$1\" = -c ] || { echo nonsense >&2; exit 7; }");
  EXPECT_THAT(refusal(figures("a", "b", "--python " + failing), 1),
              AllOf(StartsWith("nonsense\n"), HasSubstr("b/figures.py: ended with exit code 7")));
}

/// A sweep of three by two values, right at so many of 4 starts: 0, 4; 1, 3; 3, 2.
void write_sweep(const std::string& folder) {
  const auto outcomes = [](int right) {
    std::vector<nlohmann::json> trials(4, {{"outcome", "undecided"}});
    for (int i = 0; i < right; ++i)
      trials[static_cast<std::size_t>(i)] = {{"outcome", "right"}, {"steps", 2}};
    return trials;
  };
  constexpr std::array<std::array<int, 2>, 3> right = {{{0, 4}, {1, 3}, {3, 2}}};
  for (std::size_t i = 0; i < right.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string name = fmt::format("iterations-{}_min_side-{}", 100 * (i + 1), k + 1);
      replace_lines(fs::path(folder) / name, outcomes(right.at(i).at(k)), {});
    }
  }
}

class SweepFigures : public Figures {
 protected:
  SweepFigures() {
    write_experiment("trials: {every_scan: 9, max_steps: 1}\n",
                     "variants:\n"
                     "  grid:\n"
                     "    localizer.matcher.ransam.iterations: [100, 200, 300]\n"
                     "    localizer.matcher.ransam.min_side: [1, 2]\n"
                     "output: {steps: false, maps: none}\n");
    good(run_room("all"));
    write_sweep(file("all"));
  }
};

TEST_F(SweepFigures, HandWhatSweepTellsToTheScript) {
  good(figures("all", "b", "--sweep" + pretended_python()));
  EXPECT_EQ(content(file("b/sweep.json")), run("sweep --json " + file("all")).out);
  EXPECT_EQ(content("called"),
            file("b/figures.py") + "\n--out\n" + file("b") + "\n--sweep\n" + file("b/sweep.json") + "\n");
}

TEST_F(SweepFigures, RefuseWhatIsNoSweep) {
  write_experiment("trials: {every_scan: 9, max_steps: 1}\n", "seeds: 1..2\n");
  good(run_room("seeds"));
  EXPECT_THAT(refusal(figures("seeds", "c", "--sweep" + pretended_python())),
              HasSubstr("/seeds: error: no parameter varies, so that there is nothing to draw"));
  EXPECT_FALSE(fs::exists("c"));
  EXPECT_THAT(refusal(run("figures --sweep all seeds -o c")),
              StartsWith("seeds: error: is one folder too many; name that of one sweep"));
}

TEST_F(SweepFigures, HaveTheSharesOfTheSweep) {
  if (!has_matplotlib()) GTEST_SKIP() << "matplotlib is not installed";
  const Answer answer = good(figures("all", "b", "--sweep"));
  EXPECT_EQ(answer.out, "2 figures in " + file("b") + ", each as pdf, svg, png\n");
  const std::string map = content(file("b/sweep_map.svg"));
  // The parameter of the larger effect has the columns behind it: min_side 4 of 12 and 9 of 12, iterations 4,
  // 4, 5 of 8.
  const std::array<std::array<int, 3>, 2> shares = {{{0, 25, 75}, {100, 75, 50}}};
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string cell = map.substr(find_id(map, fmt::format("cell_{}_{}", r, c)), 60);
      EXPECT_THAT(cell, HasSubstr(fmt::format("<!-- {} -->", shares.at(r).at(c)))) << r << ", " << c;
    }
  }
  const std::string effects = content(file("b/sweep_effects.svg"));
  const auto place = [&](const char* id) { return attribute(effects, " x=\"", find_id(effects, id)); };
  // 1/3 and 3/4 above, 1/2, 1/2 and 5/8 below, on one axis.
  const double per_share = (place("effect_0_1") - place("effect_0_0")) / (0.75 - 1.0 / 3.0);
  EXPECT_GT(per_share, 50.0);
  EXPECT_NEAR(place("effect_1_0") - place("effect_0_0"), per_share * (0.5 - 1.0 / 3.0), 0.01);
  EXPECT_NEAR(place("effect_1_1"), place("effect_1_0"), 1e-9);
  EXPECT_NEAR(place("effect_1_2") - place("effect_1_0"), per_share * 0.125, 0.01);
}

/// Those that are drawn.
class DrawnFigures : public Figures {
 protected:
  void SetUp() override {
    if (!has_matplotlib()) GTEST_SKIP() << "matplotlib is not installed";
  }

  /// Draws SVG files only, which is quicker, by a script that was changed.
  Answer draw_svg(const std::string& folder, const std::string& out) const {
    good(figures(folder, out, pretended_python()));
    std::string script = content(file(out + "/figures.py"));
    const std::string formats = "FORMATS = [\"pdf\", \"svg\", \"png\"]";
    const std::size_t at = script.find(formats);
    EXPECT_NE(at, std::string::npos);
    std::ofstream(file(out + "/figures.py")) << script.replace(at, formats.size(), "FORMATS = [\"svg\"]");
    Answer answer = good(figures(folder, out));
    EXPECT_FALSE(fs::exists(file(out + "/fig3.pdf")));
    return answer;
  }

  [[nodiscard]] std::string svg(const std::string& name) const { return content(file(name + ".svg")); }
};

std::vector<std::string> names_of_figures() {
  std::vector<std::string> names;
  for (const char* figure : {"fig3", "fig4", "fig5"}) {
    for (const char* panel : {"", "a", "b", "c"}) names.push_back(std::string(figure) + panel);
  }
  for (const char* panel : {"d", "e", "f"}) names.push_back(std::string("fig3") + panel);
  return names;
}

TEST_F(DrawnFigures, AreWholeFilesAndTheSameEachTime) {
  run_whole("a");
  fs::rename("a", odd_name);
  const auto draw = [&] {
    const Answer answer = good(figures(odd_name, "b"));
    EXPECT_EQ(answer.err, "");
    EXPECT_EQ(answer.out, "15 figures in " + file("b") + ", each as pdf, svg, png\n");
  };
  draw();
  std::map<std::string, std::string> first;
  std::string svg_files;
  for (const std::string& name : names_of_figures()) {
    const bool is_combined = name == "fig4" || name == "fig5";
    const std::string pdf = content(file("b/" + name + ".pdf"));
    EXPECT_THAT(pdf, AllOf(StartsWith("%PDF-1."), HasSubstr("\n%%EOF"))) << name;
    EXPECT_THAT(pdf, AllOf(HasSubstr("/FontFile2"), Not(HasSubstr("/CreationDate")))) << name;
    const std::string png = content(file("b/" + name + ".png"));
    EXPECT_THAT(png, AllOf(StartsWith("\x89PNG\r\n\x1a\n"), HasSubstr("IEND"))) << name;
    if (!is_combined) {
      EXPECT_THAT(pdf, HasSubstr("/MediaBox [ 0 0 252 ")) << name;           // 3.5 in
      EXPECT_EQ(png.substr(16, 4), std::string("\0\0\x04\x1a", 4)) << name;  // of 300 pixels
    }
    svg_files += " " + file("b/" + name + ".svg");
    for (const char* extension : {".pdf", ".svg", ".png"})
      first[name + extension] = content(file("b/" + name + extension));
  }
  const std::string parse =
      "python3 -c 'import sys, xml.dom.minidom as m; [m.parse(f) for f in sys.argv[1:]]'";
  EXPECT_EQ(std::system((parse + svg_files).c_str()), 0);

  draw();
  for (const auto& [name, bytes] : first) EXPECT_EQ(content(file("b/" + name)), bytes) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(file("b")), {}), 46);  // and the script
}

TEST_F(DrawnFigures, HaveTheValuesOfTheSteps) {
  run_whole("a");
  std::vector<Json> all = steps("a");
  all[3]["hypotheses"] = 0;  // then there is no best one
  all[0].erase("omega_place");
  all[5]["clusters"] = 0;
  write_steps("a", all);
  ASSERT_THAT(draw_svg("a", "b").err, HasSubstr("as it has been changed"));

  using Value = std::function<std::optional<double>(const Json&)>;
  const auto error = [](const char* key, double factor) -> Value {
    return [=](const Json& step) -> std::optional<double> {
      if (step["verdict"] != "localized") return std::nullopt;
      return factor * step[key].get<double>();
    };
  };
  const auto expect_values = [&](const std::string& figure, const std::string& id, const Value& value,
                                 const Scale& scale = {}) {
    const std::vector<Place> drawn = curve(svg("b/" + figure), id + "_0", scale);
    std::size_t n = 0;
    for (const Json& step : all) {
      const std::optional<double> expected = value(step);
      if (!expected) continue;
      ASSERT_LT(n, drawn.size()) << id;
      EXPECT_NEAR(drawn[n].x, step["step"].get<double>(), 1e-3) << id;
      EXPECT_NEAR(drawn[n].y, *expected, 1e-4 * std::max(1.0, *expected))
          << id << " of step " << step["step"];
      ++n;
    }
    EXPECT_EQ(n, drawn.size()) << id;
    EXPECT_GT(n, 5U) << id;
  };
  expect_values("fig3a", "match", [](const Json& step) { return step["stage_ms"]["match"].get<double>(); });
  expect_values("fig3b", "omega_best", [](const Json& step) -> std::optional<double> {
    if (step["hypotheses"] == 0) return std::nullopt;
    return step["omega_best"].get<double>();
  });
  expect_values("fig3c", "omega_max", [](const Json& step) { return step["omega_max"].get<double>(); });
  expect_values("fig3d", "omega_place", [](const Json& step) -> std::optional<double> {
    if (!step.contains("omega_place")) return std::nullopt;
    return step["omega_place"].get<double>();
  });
  expect_values("fig3e", "translation", error("translation_error_m", 100.0));
  expect_values("fig3e", "rotation", error("rotation_error_deg", 1.0));
  // Linear from 0 to 1, then a decade is 0.9 times as long.
  const Scale logarithmic{[](double v) { return v <= 1.0 ? v : 1.0 + 0.9 * std::log10(v); },
                          [](double s) { return s <= 1.0 ? s : std::pow(10.0, (s - 1.0) / 0.9); }};
  expect_values(
      "fig3f", "clusters", [](const Json& step) { return step["clusters"].get<double>(); }, logarithmic);

  const auto first =
      std::find_if(all.begin(), all.end(), [](const Json& s) { return s["verdict"] == "localized"; });
  EXPECT_NEAR(curve(svg("b/fig3f"), "localized_0", logarithmic).front().x, (*first)["step"].get<double>(),
              1e-3);
}

/// Metres on a picture of the room's map, 12 m by 6 m, from places in a file.
std::vector<Place> metres(const std::vector<Place>& places, const std::vector<Place>& global_map) {
  const auto [left, right] = std::minmax_element(global_map.begin(), global_map.end(),
                                                 [](const Place& a, const Place& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(global_map.begin(), global_map.end(),
                                                 [](const Place& a, const Place& b) { return a.y < b.y; });
  std::vector<Place> result;
  for (const Place& place : places) {
    result.push_back({12.0 * (place.x - left->x) / (right->x - left->x),
                      6.0 * (bottom->y - place.y) / (bottom->y - top->y)});
  }
  return result;
}

double distance_between(const Place& a, const Place& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Share of places within 0.1 m of the map.
double share_on_map(const std::vector<Place>& places, const std::vector<Place>& map) {
  const auto is_near = [&](const Place& place) {
    return std::any_of(map.begin(), map.end(),
                       [&](const Place& other) { return distance_between(place, other) < 0.1; });
  };
  return static_cast<double>(std::count_if(places.begin(), places.end(), is_near)) /
         static_cast<double>(places.size());
}

Pose2 pose_of(const Json& json) {
  return {json["x"], json["y"], json["theta"]};
}

/// A point cloud in another frame.
std::string moved(std::string pcd, const Pose2& new_from_old) {
  const std::string data = "DATA binary\n";
  for (std::size_t i = pcd.find(data) + data.size(); i < pcd.size(); i += 3 * sizeof(float)) {
    std::array<float, 2> point{};
    std::memcpy(point.data(), pcd.data() + i, sizeof(point));
    const Pose2 place = new_from_old * Pose2{point[0], point[1], 0.0};
    point = {static_cast<float>(place.x), static_cast<float>(place.y)};
    std::memcpy(pcd.data() + i, point.data(), sizeof(point));
  }
  return pcd;
}

TEST_F(DrawnFigures, LayTheLocalMapWhereTheRobotIs) {
  run_whole("a");
  draw_svg("a", "b");
  std::vector<Json> all = steps("a");
  const auto first =
      std::find_if(all.begin(), all.end(), [](const Json& s) { return s["verdict"] == "localized"; });
  for (const char* figure : {"b/fig4b", "b/fig5b"}) {
    const std::vector<Place> global_map = dots(svg(figure), "global_map");
    const std::vector<Place> local_map = dots(svg(figure), "local_map");
    ASSERT_GT(local_map.size(), 100U);
    EXPECT_GT(share_on_map(metres(local_map, global_map), metres(global_map, global_map)), 0.95) << figure;
  }
  const std::string where_localized = svg("b/fig4b");
  const auto mark = [&](const char* id) {
    return metres({middle(where_localized, id)}, dots(where_localized, "global_map")).front();
  };
  EXPECT_LT(distance_between(mark("mark_0"), {1.0, 3.0}), 0.15);  // the world's first way point
  const Pose2 robot = pose_of((*first)["reference"]);
  EXPECT_LT(distance_between(mark("mark_1"), {robot.x, robot.y}), 0.15);

  // The same again, as if the local map had started over at some step after the declaration.
  constexpr std::size_t over = 14;
  const Pose2 new_from_old = inverse(pose_of(all[over]["local_from_robot"]));
  for (std::size_t i = over; i < all.size(); ++i) {
    const Pose2 now = i == over ? Pose2{} : new_from_old * pose_of(all[i]["local_from_robot"]);
    all[i]["local_from_robot"] = {{"x", now.x}, {"y", now.y}, {"theta", now.theta}};
  }
  write_steps("a", all);
  const std::string last = "a/maps/trial_0000/step_00" + std::to_string(all.size() - 1) + ".pcd";
  const std::string cloud = moved(content(last), new_from_old);
  std::ofstream(last, std::ios::binary) << cloud;
  draw_svg("a", "c");

  const std::vector<Place> before = dots(svg("b/fig5b"), "local_map");
  const std::vector<Place> after = dots(svg("c/fig5b"), "local_map");
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT(distance_between(before[i], after[i]), 0.01);
  EXPECT_EQ(svg("b/fig4b"), svg("c/fig4b"));  // of an earlier step
  // In the new frame the path begins at the robot, and the start lies where the reference has it.
  const std::string picture = svg("c/fig5c");
  const std::vector<Place> path = vertices(picture, "path");
  ASSERT_EQ(path.size(), all.size() - over);
  const double metres_per_point = distance(Pose2{}, pose_of(all.back()["local_from_robot"])) /
                                  distance_between(path.front(), path.back());
  EXPECT_NEAR(metres_per_point * distance_between(path.front(), middle(picture, "mark_0")),
              distance(pose_of(all[over]["reference"]), pose_of(all[0]["reference"])), 0.15);
}

TEST_F(DrawnFigures, TellWhatIsLeftOut) {
  run_whole("a");
  draw_svg("a", "b");
  ASSERT_TRUE(fs::exists("b/fig5c.svg"));
  std::ofstream("b/fig4b.png") << "of somebody else";
  fs::remove_all(file("a"));
  run_whole(
      "a",
      "--set output.maps=none --set trials.whole=false --set trials.every_scan=1 --set trials.max_steps=2");
  const Answer answer = good(figures("a", "b"));
  EXPECT_THAT(answer.out, StartsWith("7 figures in "));
  EXPECT_THAT(answer.err,
              AllOf(HasSubstr("fig4a is left out: there is no " + file("a/maps/global.pcd") +
                              "; run the experiment with --set output.maps=all"),
                    HasSubstr("fig4b is left out: the robot was never localized"),
                    HasSubstr("fig4c is left out: no step is ambiguous"), HasSubstr("fig5c is left out")));
  EXPECT_TRUE(fs::exists("b/fig3e.svg"));
  EXPECT_FALSE(fs::exists("b/fig5c.svg")) << "a figure of other results";
  EXPECT_TRUE(fs::exists("b/fig4b.png"));
}

TEST_F(DrawnFigures, OfSeveralRunsShareTheirCurves) {
  run_whole("a/1");
  run_whole("b/1", "--seed 2");
  draw_svg("a", "c");
  good(figures("a", "c", "b"));
  EXPECT_EQ(vertices(svg("c/fig3c"), "omega_max_0").size(), steps("a/1").size());
  EXPECT_EQ(vertices(svg("c/fig3c"), "omega_max_1").size(), steps("b/1").size());
  EXPECT_THAT(svg("c/fig3c"), AllOf(HasSubstr("<!-- 1 -->"), HasSubstr("<!-- 1_2 -->")));
  EXPECT_TRUE(fs::exists("c/1/fig4a.svg"));
  EXPECT_TRUE(fs::exists("c/1_2/fig5c.svg"));
  EXPECT_FALSE(fs::exists("c/fig4a.svg"));
}

TEST_F(DrawnFigures, AreDrawnByTheScriptAlone) {
  run_whole("a");
  draw_svg("a", "b");
  const std::string python =
      "$(python3 -c 'import matplotlib' 2>&- && echo python3 || echo /usr/bin/python3) ";
  const auto alone = [&](const std::string& arguments) {
    return std::system((python + "b/figures.py " + arguments + " 2>err").c_str());
  };
  EXPECT_EQ(alone(file("a") + " --out c >out"), 0);
  for (const std::string& name : names_of_figures()) EXPECT_EQ(svg("b/" + name), svg("c/" + name)) << name;
  EXPECT_NE(alone(file("missing") + " --out d"), 0);
  EXPECT_EQ(content("err"), file("missing/steps.jsonl") +
                                ": cannot be read; run the experiment with --set output.steps=true\n");
  EXPECT_NE(alone(file("a") + " --trial 3 --out d"), 0);
  EXPECT_EQ(content("err"), file("a/steps.jsonl") + ": has no steps of trial 3\n");
  fs::resize_file(file("a/maps/global.pcd"), 300);
  EXPECT_NE(alone(file("a") + " --out d"), 0);
  EXPECT_THAT(content("err"), StartsWith(file("a/maps/global.pcd") + ": is no point cloud"));
  EXPECT_TRUE(!fs::exists("d") || fs::is_empty("d"));
}

}  // namespace
}  // namespace glocal::test::figures_test

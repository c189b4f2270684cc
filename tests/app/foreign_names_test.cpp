// Names that files bring, as the program shows them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/program.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::foreign_names_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Sets a terminal's title, and turns what follows red.
const std::string on_terminals = "\033]0;PWNED\a\033[31m";

class ForeignNames : public CommandLine {
 protected:
  ForeignNames() {
    write_world();
    folder_.write("map.pgm", "P2 3 1 255\n0 255 0");
    folder_.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n");
  }

  /// A drive whose names all have `name` in them, with as many topics of scans.
  void write_recording(const std::string& file_name, const std::string& name, int topics) const {
    constexpr std::int64_t ms = 1'000'000;
    bags::RobotRecording recording;
    for (int i = 0; i < 5; ++i) {
      const std::int64_t stamp = 100 * ms * i;
      recording.transform("odom", "base" + name, stamp, Pose2{0.1 * i, 0.0, 0.0});
      recording.transform("base" + name, "laser" + name, stamp, {}, "/tf_static");
      for (int topic = 0; topic < topics; ++topic)
        recording.scan("/scan" + std::to_string(topic) + name, stamp,
                       {.frame = "laser" + name, .ranges = {1.0F, 1.0F, 1.0F}});
      recording.grid("/map" + name, stamp, 0.05F, 2, {100, 0, 0, 100});
    }
    recording.add("/odd" + name, "odd/msg/Odd" + name, 0, bags::RobotRecording::cdr());
    recording.add("/cut" + name, "sensor_msgs/msg/LaserScan", 0, bags::RobotRecording::cdr());
    folder_.write(file_name, recording.bytes());
  }

  /// Whatever a command says, a terminal prints it, and a person can read it.
  void expect_fit(const std::string& arguments) const {
    const Answer answer = run(arguments);
    for (const std::string& text : {answer.out, answer.err}) {
      const auto is_control = [](char c) {
        return (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') || c == 0x7F;
      };
      EXPECT_EQ(std::count_if(text.begin(), text.end(), is_control), 0) << arguments;
      EXPECT_LT(text.size(), 120'000U) << arguments;
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 2100U) << arguments;
    }
    EXPECT_TRUE(answer.exit_code == 0 || answer.exit_code == 2) << arguments << '\n' << answer.err;
    EXPECT_FALSE(answer.out.empty() && answer.err.empty()) << arguments;
  }
};

TEST_F(ForeignNames, OfRecordingsAreFitForATerminal) {
  write_recording("odd.mcap", on_terminals, 2);
  write_recording("long.mcap", std::string(1'000'000, 'x'), 1);
  write_recording("many.mcap", "", 500);
  for (const std::string name : {"odd.mcap", "long.mcap", "many.mcap"}) {
    folder_.write("run.yaml", fmt::format("schema: 1\nname: r\nmap: {{bag_map: {{path: {0}}}}}\n"
                                          "observations: {{bag: {{path: {0}}}}}\ntrials: {{starts_m: [0]}}\n",
                                          name));
    folder_.write("unknown.yaml",
                  fmt::format("schema: 1\nname: r\nmap: {{bag_map: {{path: {0}, topic: /no}}}}\n"
                              "observations: {{bag: {{path: {0}, scans: [/no]}}}}\n",
                              name));
    for (const char* command :
         {"bag info {0}", "localize map.yaml {0} --out a", "localize {0} {0} --out b",
          "localize map.yaml {0} --scans /no --out c", "localize map.yaml {0} --odom-frame no --out d",
          "convert {0} -o {0}.out.mcap", "convert {0} -o {0}.out.log", "convert {0} -o clouds_{0}/",
          "prepare {0} --out case_{0}", "map info run.yaml", "check run.yaml", "run run.yaml --out run_{0}",
          "run unknown.yaml", "mapping run.yaml"})
      expect_fit(fmt::format(fmt::runtime(command), name));
  }
  EXPECT_THAT(run("bag info odd.mcap").out, HasSubstr("/scan0\\u001b]0;PWNED\\u0007\\u001b[31m"));
  const Answer many = run("convert many.mcap -o a.log");
  EXPECT_THAT(many.err, HasSubstr("and 481 more like these"));
  // What machines read is whole.
  const Json info = Json::parse(run("bag info --json odd.mcap").out);
  EXPECT_EQ(info["topics"][3]["topic"], "/scan0" + on_terminals);
}

TEST_F(ForeignNames, OfOtherFilesAreFitForATerminal) {
  const std::string long_name(1'000'000, 'y');
  for (const std::string& name : {on_terminals, long_name}) {
    folder_.write("keys.yaml", "schema: 1\n" + name + ": 1\n");
    folder_.write("values.yaml",
                  fmt::format("schema: 1\nname: n\nmap: {0}\nobservations: {{{0}: {{}}}}\n", name));
    folder_.write("variants.yaml",
                  "schema: 1\nname: n\nmap: {simulation: {world: world.yaml}}\n"
                  "observations: {simulation: {world: world.yaml}}\nvariants: {\"" +
                      (name == long_name ? name.substr(0, 900'000) : "\\e[31m") + "\": {seed: 2}}\n");
    folder_.write("world.yaml", "size: [1, 1]\n" + name + ": 2\n");
    folder_.write("cloud.pcd",
                  fmt::format("VERSION .7\nFIELDS x y {0}\nSIZE 4 4 4\nTYPE F F F\n{0} 1\n", name));
    folder_.write("cloud.ply",
                  "ply\nformat ascii 1.0\nelement " + name + " 3\nproperty float x\nend_header\n");
    folder_.write("drive.log", "FLASER " + name + " 1 1\n");
    folder_.write("poses.tum", name + " 1 2 3 4 5 6 7\n");
    folder_.write("map.yaml", "image: \"" + std::string(name == long_name ? name : "\\e[31m") +
                                  "\"\nresolution: 1\norigin: [0, 0, 0]\n");
    for (const char* arguments :
         {"check keys.yaml", "check values.yaml", "check variants.yaml", "run variants.yaml --out v",
          "simulate world.yaml", "register cloud.pcd cloud.ply", "register cloud.ply cloud.pcd",
          "localize map.yaml drive.log --out l", "convert drive.log -o drive.mcap",
          "prepare drive.log --corrected poses.tum --out p"})
      expect_fit(arguments);
  }
}

/// Results that somebody has handed on.
TEST_F(ForeignNames, OfResultsAreFitForATerminal) {
  write_world();
  folder_.write("e.yaml",
                "schema: 1\nname: e\nmap: {simulation: {world: world.yaml}}\n"
                "observations: {simulation: {world: world.yaml}}\ntrials: {starts_m: [0], max_steps: 2}\n");
  for (const std::string folder : {"a", "b"}) {
    good(run("run e.yaml --quiet --out " + folder));
    for (const char* part : {"summary.json", "trials.jsonl", "steps.jsonl", "provenance.json"}) {
      std::string text = content(folder + "/" + part);
      for (const auto& [from, to] : {std::pair(R"("name":"e")", R"("name":"\u001b[31m\u009b")"),
                                     std::pair(R"("name": "e")", R"("name": "\u001b[31m\u009b")"),
                                     std::pair(R"("why":")", R"("why":"\u001b[31m)")}) {
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 9))
          text.replace(at, std::string(from).size(), to);
      }
      folder_.write(folder + "/" + part, text);
    }
  }
  for (const char* arguments : {"summarize a", "summarize --json a", "compare a b", "compare --json a b",
                                "explain a --step 1", "report a -o report.html", "reliability a"})
    expect_fit(arguments);
}

}  // namespace
}  // namespace glocal::test::foreign_names_test

// The program as its users meet it: answers on stdout, faults on stderr, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.hpp"

namespace glocal::test::command_line_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(CommandLine, WithoutArgumentsShowsHelp) {
  const Answer answer = good(run(""));
  EXPECT_THAT(answer.out, HasSubstr("Subcommands:"));
  EXPECT_EQ(answer.err, "");
}

TEST_F(CommandLine, VersionNamesTheRevision) {
  const Answer answer = good(run("--version"));
  EXPECT_THAT(answer.out, testing::MatchesRegex("glocal [0-9]+\\.[0-9]+\\.[0-9]+ \\(.+\\)\n"));
}

TEST_F(CommandLine, WrongUsageEndsWith2AndSuggests) {
  const Answer unknown = run("lst");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(unknown.out, "");
  EXPECT_EQ(unknown.err, "error: unknown command 'lst' (did you mean 'list'?)\n");
  EXPECT_EQ(refusal(run("list matchr")), "error: unknown kind 'matchr' (did you mean 'matcher'?)\n1 error\n");
  EXPECT_EQ(run("describe ransamm").err,
            "error: nothing is called 'ransamm' (did you mean 'ransam'?)\n1 error\n");
  EXPECT_EQ(run("lst --help").err, unknown.err);
  EXPECT_EQ(refusal(run("map bild a b")), "error: unknown command 'bild' (did you mean 'build'?)\n");
  EXPECT_EQ(refusal(run("map")), "error: which command of map? (there are: build, convert, align, info)\n");
  EXPECT_EQ(run("describe").exit_code, 2);
  EXPECT_EQ(run("list --frobnicate").exit_code, 2);
  EXPECT_EQ(run("--frobnicate").exit_code, 2);
}

TEST_F(CommandLine, NothingIsNoArgument) {
  for (const char* command : {"run room.yaml --out ''", "list ''", "run room.yaml --seeds '' --quiet"})
    EXPECT_THAT(refusal(run(command)), HasSubstr("glocal: error: an argument is empty: the one after '"))
        << command;
  EXPECT_EQ(
      refusal(run("''")),
      "glocal: error: an argument is empty: the one after 'glocal'; give it a value, or leave it out\n1 "
      "error\n");
}

TEST_F(CommandLine, AWrongFolderOfConfigurationsIsNamed) {
  ::setenv("GLOCAL_CONFIGS", "nowhere", 1);
  const std::string said = refusal(run("list methods"));
  ::unsetenv("GLOCAL_CONFIGS");
  EXPECT_THAT(said, HasSubstr("GLOCAL_CONFIGS: error: names 'nowhere', which is no folder"));
}

TEST_F(CommandLine, OptionsThatWereRenamedSayWhatTheyAreNow) {
  EXPECT_THAT(run("compare a b --csv c.csv").err, HasSubstr("; --csv is called -o FILE.csv now\n"));
  EXPECT_THAT(run("compare a b --markdown=c.md").err, HasSubstr("; --markdown is called -o FILE.md now\n"));
  EXPECT_THAT(run("compare a b --json c.json").err, HasSubstr("--json prints; -o c.json writes this file\n"));
  EXPECT_THAT(run("new-plugin matcher mine folder").err, HasSubstr("; -o says what to write\n"));
  EXPECT_THAT(run("convert a.log b.mcap").err, HasSubstr("--out is required"));
}

TEST_F(CommandLine, PluginsAreLoadedInAnyCommand) {
  for (const char* command : {"list", "map info a.yaml", "bag info a.bag", "leaderboard check planar@1"})
    EXPECT_THAT(refusal(run(command + std::string(" --plugin none.so"))),
                HasSubstr("none.so: error: no such file"))
        << command;
}

TEST_F(CommandLine, OptionsThatWouldDoNothingAreRefused) {
  for (const char* option : {"--every", "--after", "--fail-after"})
    EXPECT_THAT(refusal(run(std::string("mapping a.yaml --whole ") + option + " 3")),
                HasSubstr(std::string("--whole excludes ") + option));
}

TEST_F(CommandLine, WhatIsNoNumberIsNoNumberOfAnOption) {
  for (const char* command :
       {"check --budget-ms", "convert a.log -o b.mcap --max-range", "localize map.yaml a.log --every",
        "map align a b --epsilon", "mapping --after", "prepare a.log -o b --max-gap", "register a b --unit",
        "reliability a --reference-deviation"}) {
    for (const char* number : {"nan", "inf", "-1", "1x"})
      EXPECT_THAT(refusal(run(std::string(command) + " " + number)), HasSubstr(number)) << command;
    EXPECT_THAT(run(std::string(command) + " nan").err, HasSubstr("nan is not a number")) << command;
  }
}

/// "run", "map build", … of what the program says of itself.
std::vector<std::string> commands_in(const std::string& help) {
  std::vector<std::string> commands;
  std::istringstream lines(help.substr(std::min(help.find("Subcommands:\n"), help.size())));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ") && line[2] != ' ') commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return commands;
}

TEST_F(CommandLine, JsonIsPrintedAndOutSaysWhereToWriteInEveryCommand) {
  std::vector<std::string> commands = commands_in(run("--help").out);
  for (const char* above : {"map", "bag"}) {
    for (const std::string& below : commands_in(run(std::string(above) + " --help").out))
      commands.push_back(above + (" " + below));
  }
  ASSERT_GT(commands.size(), 30U);
  std::size_t that_print = 0, that_write = 0;
  for (const std::string& command : commands) {
    const std::string help = run(command + " --help").out;
    that_print += help.find("--json") != std::string::npos ? 1 : 0;
    that_write += help.find("--out") != std::string::npos ? 1 : 0;
    EXPECT_THAT(help, testing::Not(HasSubstr("--json TEXT"))) << command;
    if (help.find("--out") != std::string::npos) {
      EXPECT_THAT(help, HasSubstr("-o,--out")) << command;
    }
  }
  EXPECT_GT(that_print, 6U);
  EXPECT_GT(that_write, 12U);
}

TEST_F(CommandLine, ListsAndDescribesStrategies) {
  EXPECT_THAT(run("list").out, HasSubstr("\nmatcher\n  "));
  EXPECT_THAT(run("list matcher").out, HasSubstr("  ransam  "));
  EXPECT_THAT(run("describe ransam").out,
              HasSubstr("contact_epsilon: number or auto (> 0 m), default auto\n"));
  EXPECT_THAT(run("describe experiment").out,
              HasSubstr("threads: whole number (>= 1 and <= 256), default 1\n"));
}

TEST_F(CommandLine, SchemaIsJson) {
  const auto schema = nlohmann::json::parse(run("schema").out);
  EXPECT_TRUE(schema["$defs"].contains("matcher"));
}

TEST_F(CommandLine, CheckReportsAllFaultsOfAllFiles) {
  const std::string a = folder_.write("a.yaml", "schema: 1\nname: a\nsede: 3\n");
  const std::string b = folder_.write("b.yaml", "schema: 2\n");
  const Answer answer = run("check " + a + " " + b);
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_EQ(answer.out, "");
  EXPECT_THAT(answer.err, StartsWith(a + ":1:1: error: missing key 'map': "));
  EXPECT_THAT(answer.err, HasSubstr(a + ":3:1: error: unknown key 'sede' (did you mean 'seed'?)\n"));
  EXPECT_THAT(answer.err, HasSubstr(b + ":1:9: error: schema: 2 is out of range, must be 1\n"));
  EXPECT_THAT(answer.err, testing::EndsWith("\n9 errors\n"));
}

TEST_F(CommandLine, HelpKnowsCommandsStrategiesAndPartsOfExperiments) {
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("help merge").out, run("merge --help").out);
  EXPECT_THAT(run("help merge").out, HasSubstr("--plugin FILE"));
  EXPECT_EQ(run("help ransam").out, run("describe ransam").out);
  EXPECT_THAT(run("help trials").out, HasSubstr("max_steps: whole number"));
  EXPECT_THAT(refusal(run("help merg")), HasSubstr("called 'merg' (did you mean 'merge'?)"));
}

TEST_F(CommandLine, CheckTakesOverrides) {
  const std::string file = folder_.write("a.yaml", "schema: 1\n");
  EXPECT_THAT(
      run("check " + file + " --set localizer.matcher.ransam.iterations=0").err,
      HasSubstr("--set localizer.matcher.ransam.iterations=0: error: localizer.matcher.ransam: iterations: 0 "
                "is out of range, must be >= 1"));
  EXPECT_THAT(run("check " + file + " --set seed").err,
              HasSubstr("--set seed: error: not of the form path=value\n"));
}

TEST_F(CommandLine, ExitCodesAreTheSameWhereverStreamsLead) {
  const auto exit_code = [](const std::string& command_line) {
    const int status = std::system((GLOCAL_PROGRAM " " + command_line).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const std::string file = folder_.write("a.yaml", "schema: 2\n");
  for (const char* stderr_to : {" 2>/dev/full", " 2>&-", " >&- 2>&-", " <&- >&- 2>&-"}) {
    EXPECT_EQ(exit_code(std::string("list matchr") + stderr_to), 2) << stderr_to;
    EXPECT_EQ(exit_code("check " + file + stderr_to), 2) << stderr_to;
    EXPECT_EQ(exit_code(std::string("lst") + stderr_to), 2) << stderr_to;
    EXPECT_EQ(exit_code(std::string("list --frobnicate") + stderr_to), 2) << stderr_to;
  }
  for (const char* answer : {"", "--help", "--version", "list", "run --help"}) {
    EXPECT_EQ(exit_code(std::string(answer) + " >/dev/full 2>/dev/null"), 1) << answer;
    EXPECT_EQ(exit_code(std::string(answer) + " >&- 2>/dev/null"), 1) << answer;
  }
}

TEST_F(CommandLine, SeedAndThreadsAreReadAsInTheFile) {
  const std::string file = folder_.write("a.yaml", "schema: 1\nname: a\n");
  const auto answer = [&](const std::string& option) {
    const Answer got = run("check " + file + " " + option);
    EXPECT_EQ(got.exit_code, 2) << option;
    return got.err;
  };
  EXPECT_THAT(answer("--seed -1"), HasSubstr("--set seed=-1: error: seed: -1 is out of range, must be >= 0"));
  EXPECT_THAT(answer("--seed 99999999999999999999"),
              HasSubstr("is too large, must be <= 18446744073709551615"));
  EXPECT_THAT(answer("--seed 0x10"), HasSubstr("is not a decimal number"));
  EXPECT_THAT(answer("--seed 1.5"), HasSubstr("1.5 is not a whole number"));
  EXPECT_THAT(answer("--set seed=-1"), HasSubstr("-1 is out of range"));
  EXPECT_THAT(answer("--threads -1"), HasSubstr("-1 is out of range, must be >= 1 and <= 256"));
  EXPECT_THAT(answer("--threads 99999999999"), HasSubstr("is too large"));
  EXPECT_THAT(answer("--seed 18446744073709551615"), testing::Not(HasSubstr("seed")));
}

}  // namespace
}  // namespace glocal::test::command_line_test

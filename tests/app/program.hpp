// Runs the program as its users do.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "config/temporary_folder.hpp"

namespace glocal::test {

struct Answer {
  int exit_code;
  std::string out;
  std::string err;
};

class CommandLine : public testing::Test {
 protected:
  [[nodiscard]] Answer run(const std::string& arguments) const {
    const std::string out = folder_.path() / "out";
    const std::string err = folder_.path() / "err";
    const int status = std::system((GLOCAL_PROGRAM " " + arguments + " >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }

  static std::string content(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  TemporaryFolder folder_;
};

}  // namespace glocal::test

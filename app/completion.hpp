// What may be typed next on the command line of glocal.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"

namespace glocal::app {

struct Candidate {
  std::string text;  ///< Of the whole word.
  std::string doc = {};
};

struct Completion {
  std::vector<Candidate> candidates;
  bool files = false;  ///< Any file or folder may stand there.
};

/// For the last of these words, which follow the program's name. An empty one has not been begun.
[[nodiscard]] Completion complete(const std::vector<std::string>& words, const CLI::App& app,
                                  const Catalog& catalog);

}  // namespace glocal::app

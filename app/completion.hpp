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

/// For the last of the words, as far as it is typed, behind the program's name; no word is wanted if it is
/// empty.
[[nodiscard]] Completion complete(const std::vector<std::string>& words, const CLI::App& app,
                                  const Catalog& catalog);

}  // namespace glocal::app

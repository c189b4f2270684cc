// Cases, seeds and starts to measure methods by, under a name and a version that always mean the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "glocal/params.hpp"

namespace glocal {

struct SuiteCase {
  std::string name;
  std::string values;      ///< hash_of() what suite and files say of it.
  std::size_t starts = 0;  ///< That it has with each seed; 0 while they are not pinned.
};

/// What others have published of a case: errors while localized.
struct PublishedFigures {
  std::string case_name;
  double translation_cm = 0.0;
  double rotation_deg = 0.0;
  std::string about = {};  ///< The rest, in words.
};

struct Suite {
  std::string name;
  int version = 1;
  std::filesystem::path file;
  std::vector<std::uint64_t> seeds;
  std::vector<SuiteCase> cases;  ///< In the order of the file.
  bool is_pinned = false;        ///< Whether it says what starts, values and inputs must be.
  /// SHA-256 by file, or by folder with a '/' at its end: as input_name() has them.
  std::map<std::string, std::string> inputs;
  std::vector<PublishedFigures> published;

  /// "planar@1".
  [[nodiscard]] std::string id() const;
  [[nodiscard]] const SuiteCase* find_case(std::string_view case_name) const;
};

/// 64 bits of a text as 16 hexadecimal digits (FNV-1a): tells texts apart that nobody has made to look alike.
[[nodiscard]] std::string hash_of(std::string_view text);

/// Whether a start belongs to a share (0 to 1) of a suite. Follows from its arguments alone, and a share
/// holds all smaller ones.
[[nodiscard]] bool is_in_share(std::string_view case_name, std::uint64_t seed, std::size_t start,
                               double share);

/// The numbers of a case's starts that belong to a share.
[[nodiscard]] std::vector<std::size_t> starts_in_share(const SuiteCase& one_case, std::uint64_t seed,
                                                       double share);

/// How a suite names an input file: `data:…` for data sets, else by its way from the suite's file.
[[nodiscard]] std::string input_name(const Suite& suite, const std::filesystem::path& input);

/// A suite's file, read: the suite without the values of its cases, and what an experiment is given of it.
struct SuiteFile {
  Suite suite;
  YamlNode cases, seeds, disturbances;  ///< As an experiment has them.
};

/// Reads the suite that `value` names: NAME, NAME@VERSION, or a file with or without @VERSION. Appends what
/// is wrong to `faults`; none if it cannot be read.
[[nodiscard]] std::optional<SuiteFile> read_suite_file(const YamlNode& value, std::vector<Fault>& faults);

/// The same for its name. Throws ConfigError.
[[nodiscard]] Suite read_suite(const std::string& name);

}  // namespace glocal

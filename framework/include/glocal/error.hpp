// What is wrong with the input, said so that it can be put right.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace glocal {

/// One fault: where it is, which rule it breaks, and what to do about it.
struct Fault {
  std::string file;
  int line = 0;    ///< From 1; 0 if the fault has no line.
  int column = 0;  ///< From 1; 0 if the fault has no column.
  std::string message;
  std::string path = {};  ///< Of the keys that it is about, as "localizer.matcher.ransam"; empty if of none.

  friend auto operator<=>(const Fault&, const Fault&) = default;  // NOLINT(modernize-use-nullptr)
  friend bool operator==(const Fault&, const Fault&) = default;
};

/// `file:line:column: error: message`, leaving out what is not known; printable, whatever the file has in it.
[[nodiscard]] std::string to_string(const Fault& fault);

/// Unusable configuration or input data: the program ends with exit code 2 before anything has been written.
class ConfigError : public std::runtime_error {
 public:
  /// Faults are sorted by place; what() has one on each line. Of more than 200, the last says how many more
  /// there are.
  explicit ConfigError(std::vector<Fault> faults);
  /// One fault without a line. The place is a file, a folder, or an option; empty if there is none.
  ConfigError(const std::filesystem::path& place, const std::string& message);
  [[nodiscard]] const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// Something failed while running (disk full, folder not writable): exit code 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A strategy threw an exception or broke its contract (strategies.hpp): what() names it and the step.
class StrategyError : public RunError {
 public:
  using RunError::RunError;
};

}  // namespace glocal

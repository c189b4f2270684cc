// What all processes have done so far that have left a journal in a folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "evaluation/results/journal.hpp"

namespace glocal {

/// A trial is given up when it has ended its process so often.
inline constexpr std::size_t most_crashes = 2;

/// Reads the journals of a folder, also while they are written. What trials leave stays in the files: memory
/// holds where it is.
class JournalScan {
 public:
  struct Journal {
    std::filesystem::path file;
    std::string host;
    std::size_t jobs = 1;    ///< Trials at once.
    bool is_closed = false;  ///< Its writer is done.
    /// Its writer is at work: the file was written, or touched, not long ago by the clock of its server.
    bool is_live = false;
    std::uint64_t read = 0;   ///< Bytes.
    bool is_damaged = false;  ///< Some of its lines are.
    std::string index = {};   ///< What was read of it since the last index, with places instead of outputs.
  };
  /// Part of a line.
  struct Place {
    std::size_t journal = 0;
    std::uint64_t offset = 0, size = 0;
  };
  struct Finished {
    Place entry;  ///< JSON for entry_of().
    double ms = 0.0;
    Outcome outcome = Outcome::undecided;
    std::vector<Place> files;  ///< Texts for file_of_line().
  };

  /// What is read of a journal whose writer is done: all of it, or an index beside it. Who reads indexes
  /// writes those that are missing; who reads all removes that of a journal with damaged lines.
  enum class Closed { whole, indexed };

  /// `warn` is told of lines that are damaged; these do not count.
  JournalScan(std::filesystem::path folder, std::function<void(const std::string&)> warn,
              Closed closed = Closed::whole);

  /// Reads what was written since the last call. Throws RunError for a file that cannot be read.
  void update();

  [[nodiscard]] const std::vector<Journal>& journals() const { return journals_; }
  /// Writers that are at work.
  [[nodiscard]] std::size_t count_live() const;
  /// Trials that are over. One that was run twice counts once.
  [[nodiscard]] const std::unordered_map<TrialId, Finished, TrialIdHash>& finished() const {
    return finished_;
  }
  /// Trials that were begun, and are not over: their lines `start`.
  [[nodiscard]] const std::unordered_map<TrialId, Place, TrialIdHash>& begun() const { return begun_; }
  [[nodiscard]] const std::unordered_map<TrialId, std::vector<Crash>, TrialIdHash>& crashes() const {
    return crashes_;
  }
  /// The trial has ended its process as often as it may, and has no result.
  [[nodiscard]] bool is_given_up(const TrialId& id) const;
  /// Descriptions of variants by identity, one for each journal that has one.
  [[nodiscard]] const std::map<std::string, std::vector<Place>>& variants() const { return variants_; }

  /// Throws RunError.
  [[nodiscard]] std::string text_at(const Place& place) const;

 private:
  void find_journals();
  void read(std::size_t journal);
  void take_line(std::size_t journal, std::uint64_t offset, std::string_view line);
  void take_content(std::size_t journal, std::optional<std::uint64_t> offset, std::string_view content);
  [[nodiscard]] bool take_index(std::size_t journal);
  void update_index(Journal& journal);
  [[nodiscard]] int descriptor_of(std::size_t journal) const;

  std::filesystem::path folder_;
  std::function<void(const std::string&)> warn_;
  Closed closed_;
  std::vector<Journal> journals_;
  std::map<std::string, std::size_t> known_;  ///< By the name that a file has when it is closed.
  std::unordered_map<TrialId, Finished, TrialIdHash> finished_;
  std::unordered_map<TrialId, Place, TrialIdHash> begun_;
  std::unordered_map<TrialId, std::vector<Place>, TrialIdHash> files_;  ///< Of trials that are not finished.
  std::unordered_map<TrialId, std::vector<Crash>, TrialIdHash> crashes_;
  std::map<std::string, std::vector<Place>> variants_;
  mutable std::map<std::size_t, Descriptor> open_;  ///< Some of the files.
};

}  // namespace glocal

// The lines of steps.jsonl of one trial, as columns.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glocal {

/// A column has one value for each step, null where the step has none, and what the page shows of it: five
/// digits, poses to a millimetre and a ten-thousandth of a radian. Repeated keys and digits that nobody sees
/// are what makes lines large.
class StepColumns {
 public:
  /// Keeps the best of each step's clusters.
  explicit StepColumns(std::size_t clusters);

  /// The trial's next line. Throws std::exception for one that is not as glocal run writes it, or that is not
  /// of the next step; what was added before stays, but nothing may be added any more.
  void add(const nlohmann::ordered_json& line);

  [[nodiscard]] std::size_t size() const { return steps_; }
  /// Wall-clock times of whole steps, ms.
  [[nodiscard]] const std::vector<float>& step_ms() const { return step_ms_; }
  /// Such as {"step": [0, 1], "verdict": ["searching", "localized"], …}. "verifications" are no column: they
  /// are those of the steps that have one, with their step.
  [[nodiscard]] nlohmann::ordered_json to_json() const;

 private:
  using Column = nlohmann::ordered_json;

  void go_to_space();
  void add_numbers(const nlohmann::ordered_json& line);
  void add_poses(const nlohmann::ordered_json& line);
  void add_verification(const nlohmann::ordered_json& line);
  void add_evidence(const nlohmann::ordered_json& line);
  void add_clusters(const nlohmann::ordered_json& line);
  void add_sentence(const std::string& why);
  [[nodiscard]] nlohmann::ordered_json best_to_json() const;

  std::size_t clusters_;
  std::size_t steps_ = 0;
  bool is_in_space_ = false;
  nlohmann::ordered_json columns_;
  std::vector<float> step_ms_;
  nlohmann::ordered_json evidence_ = nlohmann::ordered_json::object();
  std::vector<std::size_t> first_best_ = {0};             ///< Of each step, and one more.
  std::map<std::string, std::vector<double>> best_ = {};  ///< By what they are: most of all numbers.
  nlohmann::ordered_json sentences_ = nlohmann::ordered_json::array();
  std::map<std::string, std::size_t> sentence_numbers_;
};

}  // namespace glocal

// How a trial ended.
#pragma once

#include <string>

namespace glocal {

/// Judged by the limits of the experiment's key `evaluation`.
enum class Outcome {
  right,      ///< Declared, and within the limits.
  wrong,      ///< Declared, and outside of them.
  undecided,  ///< Never declared.
  declared,   ///< Declared, but there is no reference to check it against.
  failed,     ///< A strategy threw an exception or broke its contract.
};

/// The name used in results.
[[nodiscard]] const char* to_string(Outcome outcome);

/// The other way round. Throws std::invalid_argument where there is no outcome of that name.
[[nodiscard]] Outcome outcome_of(const std::string& name);

}  // namespace glocal

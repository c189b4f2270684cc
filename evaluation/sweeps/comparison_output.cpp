#include "evaluation/sweeps/comparison_output.hpp"

#include "evaluation/comparison/comparison_report.hpp"
#include "evaluation/comparison/comparison_writers.hpp"
#include "evaluation/sweeps/analysis.hpp"
#include "evaluation/sweeps/parameter_report.hpp"

namespace glocal {

ComparisonOutput comparison_output(const std::vector<NamedRun>& runs, std::size_t baseline,
                                   std::span<const Measure> measured) {
  const Comparison comparison = compare(runs, baseline, measured);
  ComparisonOutput output{first_screen(comparison), {}, to_json(comparison), to_csv(comparison)};
  Report parameters;
  if (const auto figures = compare_parameters(runs, has_time(measured))) {
    parameters = parameter_report(*figures);
    output.json["parameters"] = to_json(*figures);
  }
  output.full = comparison_report(comparison, parameters);
  return output;
}

}  // namespace glocal

// A robot that is switched off and on again: it is told where it was, and may have been carried elsewhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/builtin.hpp"
#include "glocal/experiment.hpp"
#include "glocal/localizer.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::power_cycles_test {
namespace {

constexpr std::size_t cycles = 25;  ///< Of each kind.
constexpr std::size_t most_steps = 15;
constexpr double odds = 19.0;

/// What became of power cycles of one kind.
struct Outcomes {
  std::size_t right = 0, wrong = 0, undecided = 0, steps = 0;
};

/// Where a robot is switched on in a cycle: all over the drive.
std::size_t place(const std::vector<Sample>& drive, std::size_t cycle) {
  return cycle * (drive.size() - 3 * most_steps) / cycles;
}

/// A building with two floors of like rooms, and a drive through each.
class Building {
 public:
  Building(int ground, int first) {
    register_builtin_strategies(catalog_);
    const auto office = [](int number) {
      return fmt::format("{{office: {{side: 30, number: {}}}}}", number);
    };
    const auto file = folder_.write(
        "office.yaml",
        fmt::format(
            "schema: 1\nname: office\n"
            "map: {{several: {{maps: [{{name: ground, source: {0}}}, {{name: first, source: {1}}}]}}}}\n"
            "observations: {{several: {{drives: [{{map: ground, source: {0}}}, {{map: first, source: "
            "{1}}}]}}}}\n"
            "trials: {{every_m: 2}}\n"
            "localizer:\n  local_mapper: bounded\n  matcher: indexed_ransam\n"
            "  threshold_policy: {{fixed: {{omega_max: 0}}}}\n  verdict_rule: staged_margin\n"
            "  verifier: whole_map\n",
            office(ground), office(first)));
    experiment_ = read_experiment(file, {}, catalog_);
    loaded_ = std::make_unique<LoadedExperiment>(load_experiment(experiment_, catalog_, [](const auto&) {}));
    localizer_ = std::make_unique<Localizer>(make_localizer(experiment_, catalog_, *loaded_));
    for (const Sample& sample : loaded_->drive.samples)
      floors_.at(static_cast<std::size_t>(sample.segment)).push_back(sample);
  }

  [[nodiscard]] const std::vector<Sample>& drive(std::size_t floor) const { return floors_.at(floor); }

  /// Switched off where `off` was made, or nowhere, and on again where the drive goes on from `on`.
  void cycle(const Sample* off, const std::vector<Sample>& drive, std::size_t on, Outcomes& outcomes,
             bool is_elsewhere = false) {
    localizer_->reset(on);
    if (off) localizer_->expect({*off->map_from_robot, odds});
    for (std::size_t i = on; i < on + most_steps; ++i) {
      const StepResult result = localizer_->step(drive[i].observation);
      ++outcomes.steps;
      if (result.verdict.kind != VerdictKind::localized) continue;
      const PoseError error = pose_error(*result.verdict.map_from_robot, *drive[i].map_from_robot);
      const bool is_right = !is_elsewhere && judge(error, experiment_.evaluation) == Outcome::right;
      ++(is_right ? outcomes.right : outcomes.wrong);
      return;
    }
    ++outcomes.undecided;
  }

 private:
  TemporaryFolder folder_;
  Catalog catalog_;
  Experiment experiment_;
  std::unique_ptr<LoadedExperiment> loaded_;
  std::unique_ptr<Localizer> localizer_;
  std::array<std::vector<Sample>, 2> floors_;
};

TEST(PowerCycles, AHundredAreRightOrUndecidedWhereverTheRobotWasCarried) {
  Building building(4, 5);
  const Building other(6, 7);
  const auto &drive = building.drive(0), &other_floor = building.drive(1), &elsewhere_drive = other.drive(0);
  Outcomes fresh, same, moved, carried, lifted, elsewhere, fresh_elsewhere;
  for (std::size_t c = 0; c < cycles; ++c) {
    const std::size_t off = place(drive, c);
    std::size_t ahead = off;
    while (distance(*drive[ahead].map_from_robot, *drive[off].map_from_robot) < 2.0) ++ahead;
    building.cycle(nullptr, drive, off, fresh);
    building.cycle(&drive[off], drive, off, same);
    building.cycle(&drive[off], drive, std::min(ahead, drive.size() - most_steps), moved);
    building.cycle(&drive[off], drive, place(drive, (c + cycles / 2) % cycles), carried);
    building.cycle(&drive[off], other_floor, place(other_floor, c), lifted);
    // Nothing is found there, which takes all steps.
    if (c % 5 != 0) continue;
    building.cycle(&drive[off], elsewhere_drive, place(elsewhere_drive, c), elsewhere, true);
    building.cycle(nullptr, elsewhere_drive, place(elsewhere_drive, c), fresh_elsewhere, true);
  }
  for (const Outcomes* kind : {&same, &moved, &carried, &lifted}) EXPECT_EQ(kind->wrong, 0U);
  EXPECT_LE(elsewhere.wrong, fresh_elsewhere.wrong) << "the state makes nothing wrong in another building";
  EXPECT_GE(same.right, fresh.right);
  EXPECT_LT(same.steps, fresh.steps) << "it is sure sooner where it was switched off";
  EXPECT_GT(carried.right, cycles / 2);
  EXPECT_GT(lifted.right, cycles / 2);
  EXPECT_EQ(elsewhere.right, 0U);
  for (const auto& [name, kind] :
       {std::pair("fresh", fresh), std::pair("same", same), std::pair("moved", moved),
        std::pair("carried", carried), std::pair("lifted", lifted), std::pair("elsewhere", elsewhere),
        std::pair("fresh_elsewhere", fresh_elsewhere)}) {
    RecordProperty(name, fmt::format("{} right, {} wrong, {} undecided, {} steps", kind.right, kind.wrong,
                                     kind.undecided, kind.steps));
  }
}

}  // namespace
}  // namespace glocal::test::power_cycles_test

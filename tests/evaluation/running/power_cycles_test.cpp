// A robot that is switched off and on again: it is told where it was, and may have been carried elsewhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/trials.hpp"
#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/experiment.hpp"
#include "glocal/localizer.hpp"

namespace glocal::test::power_cycles_test {
namespace {

constexpr std::size_t cycles = 25;  ///< Of each kind.
constexpr std::size_t most_steps = 15;
constexpr double odds = 19.0;

/// What became of power cycles of one kind.
struct Outcomes {
  std::size_t right = 0, wrong = 0, undecided = 0, steps = 0;
};

/// A building with like rooms, and a drive through it.
class Building {
 public:
  explicit Building(int number) {
    register_builtin_strategies(catalog_);
    const std::string office = fmt::format("{{office: {{side: 30, number: {}}}}}", number);
    const auto file = folder_.write(
        "office.yaml",
        fmt::format("schema: 1\nname: office\nmap: {}\nobservations: {}\ntrials: {{every_m: 2}}\n"
                    "localizer:\n  local_mapper: bounded\n  matcher: indexed_ransam\n"
                    "  threshold_policy: {{fixed: {{omega_max: 0}}}}\n  verdict_rule: staged_margin\n"
                    "  verifier: whole_map\n",
                    office, office));
    experiment_ = read_experiment(file, {}, catalog_);
    loaded_ = std::make_unique<LoadedExperiment>(load_experiment(experiment_, catalog_, [](const auto&) {}));
    localizer_ = std::make_unique<Localizer>(make_localizer(experiment_, catalog_, *loaded_));
  }

  [[nodiscard]] const std::vector<Sample>& drive() const { return loaded_->drive.samples; }

  /// Where a robot is switched off in a cycle.
  [[nodiscard]] std::size_t place(std::size_t cycle) const {
    return cycle * (drive().size() - 3 * most_steps) / cycles;
  }

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
};

TEST(PowerCycles, AHundredAreRightOrUndecidedWhereverTheRobotWasCarried) {
  Building building(4), other_floor(5);
  const auto& drive = building.drive();
  Outcomes fresh, same, moved, carried, elsewhere, fresh_elsewhere;
  for (std::size_t c = 0; c < cycles; ++c) {
    const std::size_t off = building.place(c);
    std::size_t ahead = off;
    while (distance(*drive[ahead].map_from_robot, *drive[off].map_from_robot) < 2.0) ++ahead;
    building.cycle(nullptr, drive, off, fresh);
    building.cycle(&drive[off], drive, off, same);
    building.cycle(&drive[off], drive, std::min(ahead, drive.size() - most_steps), moved);
    building.cycle(&drive[off], drive, building.place((c + cycles / 2) % cycles), carried);
    building.cycle(&drive[off], other_floor.drive(), other_floor.place(c), elsewhere, true);
    building.cycle(nullptr, other_floor.drive(), other_floor.place(c), fresh_elsewhere, true);
  }
  for (const Outcomes* kind : {&same, &moved, &carried}) EXPECT_EQ(kind->wrong, 0U);
  EXPECT_LE(elsewhere.wrong, fresh_elsewhere.wrong) << "the state makes nothing wrong on another floor";
  EXPECT_GE(same.right, fresh.right);
  EXPECT_LT(same.steps, fresh.steps) << "it is sure sooner where it was switched off";
  EXPECT_GT(carried.right, cycles / 2);
  EXPECT_EQ(elsewhere.right, 0U);
  for (const auto& [name, kind] :
       {std::pair("fresh", fresh), std::pair("same", same), std::pair("moved", moved),
        std::pair("carried", carried), std::pair("elsewhere", elsewhere),
        std::pair("fresh_elsewhere", fresh_elsewhere)}) {
    RecordProperty(name, fmt::format("{} right, {} wrong, {} undecided, {} steps", kind.right, kind.wrong,
                                     kind.undecided, kind.steps));
  }
}

}  // namespace
}  // namespace glocal::test::power_cycles_test

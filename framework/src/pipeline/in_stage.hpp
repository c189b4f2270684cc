// How the localizer does the work of a stage.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <string>

#include "cpu_time.hpp"
#include "glocal/error.hpp"
#include "glocal/localizer.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {

/// "matcher 'ransam'", and what has happened there: "breaks its contract in step 3".
[[nodiscard]] std::string text_of(const RunningStage& stage, const char* what);

/// Does a stage's work, and adds how long it took.
template <class Work>
void timed(double StageTimes::*stage, StepResult& result, Work work) {
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t cpu_start = cpu_time_ns();
  work();
  result.stage_cpu_ms.*stage += 1e-6 * static_cast<double>(cpu_time_ns() - cpu_start);
  result.stage_ms.*stage +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
void Localizer::in_stage(RunningStage& stage, std::size_t step, Work work) const {
  stage.trial = trial_;
  stage.step = step;
  const StageScope scope(&stage);
  try {
    work();
  } catch (const BrokenContract& broken) {
    throw StrategyError(fmt::format("{}: {}", text_of(stage, "breaks its contract"), broken.what()));
  } catch (const std::exception& error) {
    throw StrategyError(fmt::format("{}: {}", text_of(stage, "threw an exception"), error.what()));
  } catch (...) {
    throw StrategyError(text_of(stage, "threw something that is no std::exception"));
  }
}

}  // namespace glocal

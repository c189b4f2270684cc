// Experiments with variants, seeds, samples and shards whose numbers nobody meant: checked, run whole and in
// shards, put together.
#include "fuzz/commands.hpp"
#include "fuzz/draw.hpp"
#include "fuzz/harness.hpp"

namespace {

using glocal::fuzz::Draw;

std::string drawn_seeds(Draw& draw) {
  switch (draw.one_of(4)) {
    case 0:
      return draw.digits(1);
    case 1:
      return draw.digits(1) + ".." + draw.digits(2);
    case 2:
      return "[" + draw.digits(1) + ", 3..4]";
    default:
      return "1..2";
  }
}

std::string drawn_changes(Draw& draw) {
  const std::string iterations = "localizer.matcher.ransam.iterations";
  switch (draw.one_of(5)) {
    case 0:
      return "variants: {a: {seed: " + draw.digits(1) + "}, \"" + draw.name("b") + "\": {seed: 2}}\n";
    case 1:
      return "variants: {grid: {" + iterations + ": [100, " + draw.digits(50) + "]}}\n";
    case 2:
      return "variants: {sample: {count: " + draw.digits(2) + ", method: sobol, ranges: {" + iterations +
             ": [" + draw.digits(10) + ", " + draw.digits(100) + "]}}}\n";
    case 3:
      return "variants: {" + draw.name("a") + ": {trials.max_steps: " + draw.digits(1) + "}}\n";
    default:
      return "";
  }
}

std::string drawn_experiment(Draw& draw) {
  std::string yaml = "schema: 1\nname: \"" + std::string(draw.byte() == 0xFF ? "a b" : "e") + "\"\n";
  if (draw.byte() % 2 == 0) {
    yaml += "seeds: " + drawn_seeds(draw) + "\n";
  } else {
    yaml += "seed: " + draw.digits(1) + "\n";
  }
  yaml += "map: {simulation: {world: world.yaml, resolution: " + draw.digits(0.25) + "}}\n";
  yaml += "observations: {simulation: {world: world.yaml, laser: {fov_deg: " + draw.digits(180) +
          ", max_range: " + draw.digits(5) + "}}}\n";
  yaml += "trials: {starts_m: [" + draw.digits(0) + ", " + draw.digits(1) + "], max_steps: 1}\n";
  yaml += "localizer: {matcher: {ransam: {iterations: 100}}, contact_epsilon: " + draw.digits(0.25) + "}\n";
  return yaml + drawn_changes(draw);
}

}  // namespace

extern "C" int fuzz_experiment_commands(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  std::string world = "size: [" + draw.digits(6) + ", " + draw.digits(4) + "]\n";
  world += "walls: [{points: [[0, 0], [6, 0], [6, 4], [" + draw.digits(0) + ", 4]], closed: true}]\n";
  fuzz::write("world.yaml",
              world + "free_from: [[1, 1]]\nway_points: [[1, 1], [" + draw.digits(5) + ", 1]]\n");
  const std::string file = fuzz::write("e.yaml", drawn_experiment(draw)).string();
  const std::string out = std::filesystem::path(file).parent_path() / "out";
  std::filesystem::remove_all(out);
  // Few trials: what the input says about their number is for `check`.
  const std::string few = "trials.max_steps=1";
  switch (draw.one_of(4)) {
    case 0:
      fuzz::run_command(app::add_check, {"check", file});
      break;
    case 1:
      fuzz::run_command(app::add_run, {"run", file, "--shard", draw.digits(1) + "/" + draw.digits(2), "--out",
                                       out, "--quiet"});
      fuzz::run_command(app::add_status, {"status", out});
      fuzz::run_command(app::add_merge, {"merge", out});
      break;
    default:
      fuzz::run_command(app::add_run, {"run", file, "--set", few, "--out", out, "--quiet"});
      fuzz::run_command(app::add_summarize, {"summarize", out});
      fuzz::run_command(app::add_compare, {"compare", out});
      break;
  }
  return 0;
}

// Recordings that are whole, with messages that nobody meant, given to each command that takes them.
#include "fuzz/commands.hpp"
#include "fuzz/drawn_recording.hpp"
#include "fuzz/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  const std::size_t command = draw.one_of(10);
  const std::string recording = fuzz::write("recording.mcap", fuzz::drawn_recording(draw)).string();
  fuzz::write("map.pgm", "P2 4 4 255 0 0 0 0 0 255 255 0 0 255 255 0 0 0 0 0\n");
  const std::string map =
      fuzz::write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [-1, -1, 0]\n").string();
  const std::filesystem::path out = std::filesystem::path(recording).parent_path() / "out";
  std::filesystem::remove_all(out);
  const std::string result = out / "result";
  const std::vector<std::string> localize = {"localize", map,       recording, "--out",
                                             result,     "--force", "--set",   "trials.max_steps=2"};
  switch (command) {
    case 0:
      fuzz::run_command({"bag", "info", recording});
      break;
    case 1:
      fuzz::run_command({"bag", "info", "--json", recording});
      break;
    case 2:
      fuzz::run_command({"convert", recording, result + ".mcap"});
      break;
    case 3:
      fuzz::run_command({"convert", recording, result + ".log", "--scans", "/scan"});
      break;
    case 4:
      fuzz::run_command({"convert", recording, result + "/", "--scans", "/points"});
      break;
    case 5:
      fuzz::run_command({"prepare", recording, "--out", result, "--reference", "/truth"});
      break;
    case 6: {
      const auto experiment =
          fuzz::write("e.yaml",
                      "schema: 1\nname: e\nmap: {bag_map: {path: recording.mcap}}\n"
                      "observations: {bag: {path: recording.mcap}}\ntrials: {starts_m: [0]}\n");
      fuzz::run_command({"map", "info", experiment.string()});
      break;
    }
    case 7: {
      std::vector<std::string> on_its_map = localize;
      on_its_map[1] = recording;
      fuzz::run_command(on_its_map);
      break;
    }
    default:
      fuzz::run_command(localize);
      break;
  }
  return 0;
}

// Recordings that are whole, with messages that nobody meant, given to each command that takes them.
#include "fuzz/commands.hpp"
#include "fuzz/drawn_recording.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_recording_commands(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  const std::size_t command = draw.one_of(7);
  const std::string recording = fuzz::write("recording.mcap", fuzz::drawn_recording(draw)).string();
  const std::filesystem::path out = std::filesystem::path(recording).parent_path() / "out";
  std::filesystem::remove_all(out);
  const std::string result = out / "result";
  switch (command) {
    case 1:
      fuzz::run_command(app::add_bag, {"bag", "info", recording});
      break;
    case 2:
      fuzz::run_command(app::add_bag, {"bag", "info", "--json", recording});
      break;
    case 3:
      fuzz::run_command(app::add_convert, {"convert", recording, "-o", result + ".mcap"});
      break;
    case 4:
      fuzz::run_command(app::add_convert, {"convert", recording, "-o", result + ".log", "--scans", "/scan"});
      break;
    case 5:
      fuzz::run_command(app::add_convert, {"convert", recording, "-o", result + "/", "--scans", "/points"});
      break;
    case 6:
      fuzz::run_command(app::add_prepare, {"prepare", recording, "--out", result, "--reference", "/truth"});
      break;
    default: {
      const auto experiment =
          fuzz::write("e.yaml",
                      "schema: 1\nname: e\nmap: {bag_map: {path: recording.mcap}}\n"
                      "observations: {bag: {path: recording.mcap}}\ntrials: {starts_m: [0]}\n");
      fuzz::run_command(app::add_map, {"map", "info", experiment.string()});
    }
  }
  return 0;
}

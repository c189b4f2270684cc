// Maps and drives that are whole, with contents that nobody meant, to the end of a localization.
#include "fuzz/commands.hpp"
#include "fuzz/drawn_files.hpp"
#include "fuzz/drawn_recording.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_localize_contents(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  const std::size_t kind = draw.one_of(4);
  const std::string recording = fuzz::write("recording.mcap", fuzz::drawn_recording(draw)).string();
  const std::filesystem::path out = std::filesystem::path(recording).parent_path() / "out";
  std::filesystem::remove_all(out);
  std::vector<std::string> arguments = {"localize",
                                        kind == 0 ? recording : fuzz::drawn_map(draw).file,
                                        kind < 3 ? recording : fuzz::drawn_log(draw),
                                        "--out",
                                        out / "result",
                                        "--force",
                                        "--set",
                                        "trials.max_steps=2"};
  if (draw.byte() % 4 != 0) {
    for (const char* quick : {"localizer.matcher={ransam: {iterations: 100}}", "localizer.verifier=none"})
      arguments.insert(arguments.end(), {"--set", quick});
  }
  fuzz::run_command(app::add_localize, arguments);
  return 0;
}

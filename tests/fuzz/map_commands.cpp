// Maps and clouds that are whole, with contents that nobody meant, given to each command that takes them.
#include "fuzz/commands.hpp"
#include "fuzz/drawn_files.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_map_commands(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  const std::size_t command = draw.one_of(4);
  const fuzz::DrawnMap map = fuzz::drawn_map(draw);
  const std::filesystem::path out = std::filesystem::path(map.file).parent_path() / "out";
  std::filesystem::remove_all(out);
  const std::string result = out / "result";
  const std::string log = fuzz::drawn_log(draw);
  switch (command) {
    case 0:
      fuzz::run_command(app::add_register, {"register", map.file, fuzz::drawn_pcd(draw, "other.pcd"), "--out",
                                            result + ".pcd", "--force"});
      break;
    case 1:
      fuzz::run_command(app::add_convert, {"convert", log, "-o", result + ".mcap"});
      break;
    case 2:
      fuzz::run_command(app::add_prepare, {"prepare", log, "--out", result, "--corrected", log});
      break;
    default: {
      const auto experiment = fuzz::write("e.yaml", "schema: 1\nname: e\nmap: {" + map.source +
                                                        "}\nobservations: {carmen_log: {path: drive.log}}\n");
      fuzz::run_command(app::add_map, {"map", "info", experiment.string()});
    }
  }
  return 0;
}

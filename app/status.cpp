// glocal status: how far the shards of an experiment are.
#include "evaluation/sharding/status.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "app/commands.hpp"
#include "app/interrupts.hpp"
#include "app/progress.hpp"
#include "app/standard_streams.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

struct StatusCommand {
  std::string folder;
  bool watch = false;
  bool json = false;
};

Json to_json(const VariantStatus& v) {
  return {{"name", v.name},   {"trials", v.trials}, {"done", v.done},       {"right", v.right},
          {"wrong", v.wrong}, {"failed", v.failed}, {"running", v.running}, {"missing", v.missing()}};
}

Json to_json(const SharedStatus& status) {
  Json variants = Json::array();
  for (const VariantStatus& v : status.variants) variants.push_back(to_json(v));
  Json json = {{"all", to_json(status.total())},
               {"variants", std::move(variants)},
               {"live_shards", status.live_shards},
               {"silent", status.silent}};
  if (status.seconds_left) json["seconds_left"] = *status.seconds_left;
  return json;
}

std::string row(const VariantStatus& v, std::size_t width) {
  return fmt::format("{:<{}}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}\n", v.name, width, v.trials,
                     v.done, v.right, v.wrong, v.failed, v.running, v.missing());
}

std::string text_of(const SharedStatus& status, const Manifest& manifest) {
  const VariantStatus total = status.total();
  std::size_t width = 7;
  for (const VariantStatus& v : status.variants) width = std::max(width, v.name.size());
  const double share =
      total.trials == 0 ? 1.0
                        : static_cast<double>(total.done + total.failed) / static_cast<double>(total.trials);
  std::string text =
      fmt::format("{}  {} {} of {} trials done, {} {} at work{}\n", manifest.experiment, text_bar(share),
                  total.done + total.failed, total.trials, status.live_shards,
                  status.live_shards == 1 ? "shard" : "shards", time_left(status.seconds_left));
  text += fmt::format("{:<{}}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}\n", "variant", width, "trials",
                      "done", "right", "wrong", "failed", "running", "missing");
  for (const VariantStatus& v : status.variants) {
    if (!v.name.empty()) text += row(v, width);
  }
  text += row(total, width);
  if (total.missing() == 0) return text;
  for (const std::string& journal : status.silent)
    text += fmt::format("{}: its process has gone without a word; what it had not finished is missing\n",
                        journal);
  return text;
}

/// Writes over what it has written, on a terminal; elsewhere a line whenever something has changed.
void watch(const Manifest& manifest, JournalScan& scan) {
  constexpr std::chrono::seconds between{2};
  const bool on_terminal = isatty(STDOUT_FILENO) == 1;
  std::string before;
  listen_to_interrupts();
  while (!is_interrupted()) {
    const SharedStatus status = status_of(manifest, scan);
    const std::string text = text_of(status, manifest);
    const std::string line = text.substr(0, text.find('\n') + 1);
    if (on_terminal) answer_on_cleared_screen(text);
    if (!on_terminal && line != before) answer(line);
    flush_answers();
    before = line;
    const VariantStatus total = status.total();
    if (total.done + total.failed == total.trials) return;
    for (auto waited = std::chrono::milliseconds(0); waited < between && !is_interrupted();
         waited += std::chrono::milliseconds(100))
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    scan.update();
  }
}

void show_status(const StatusCommand& command) {
  const Manifest manifest = read_manifest(command.folder);
  JournalScan scan(journals_folder(command.folder), warn, JournalScan::Closed::indexed);
  if (command.watch) {
    watch(manifest, scan);
  } else if (command.json) {
    answer("{}\n", to_json(status_of(manifest, scan)).dump(2));
  } else {
    answer(text_of(status_of(manifest, scan), manifest));
  }
}

}  // namespace

void add_status(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<StatusCommand>();
  CLI::App* command = app.add_subcommand("status", "Say how far the shards of an experiment are.");
  command->add_option("DIR", options->folder, "Folder that the shards share")->required();
  CLI::Option* watch =
      command->add_flag("--watch", options->watch, "Go on until all is done, or until Ctrl-C");
  command->add_flag("--json", options->json, "All numbers as JSON")->excludes(watch);
  command->callback([options] { show_status(*options); });
}

}  // namespace glocal::app

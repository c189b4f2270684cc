// How fast recordings of robots are read, beside the bare decompressor. 64 MB of scans in chunks of 1 MB.
#include <benchmark/benchmark.h>
#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/rng.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/recording.hpp"
#include "temporary_folder.hpp"

namespace glocal::bench {
namespace {

using namespace test::bags;

constexpr std::size_t chunks = 64;
constexpr std::size_t chunk_bytes = 1'000'000;

/// Scans of 1,081 beams along walls, with a noise of 1 cm: what a laser of today sends.
std::string scan(const std::string& encoding, std::size_t number) {
  Rng rng = Rng(1).stream({number});
  Writer writer(encoding);
  writer.header("laser", static_cast<std::int64_t>(number) * 25'000'000);
  for (const float v : {-2.356F, 2.356F, 0.00436F, 0.0F, 0.025F, 0.06F, 30.0F}) writer.number(v);
  constexpr std::uint32_t beams = 1081;
  writer.number(beams);
  for (std::uint32_t i = 0; i < beams; ++i) {
    const double range =
        4.0 + 2.0 * std::sin(0.01 * i + 0.02 * static_cast<double>(number)) + rng.normal(0.01);
    writer.number(static_cast<float>(std::round(1000.0 * range) / 1000.0));
  }
  return writer.number<std::uint32_t>(0).bytes();
}

/// A chunk, unpacked, and the numbers of its messages.
struct Records {
  std::string bytes = {};
  std::size_t first = 0, last = 0;
};

std::vector<Records> records_of(const std::string& encoding) {
  std::vector<Records> all(chunks);
  std::size_t number = 0;
  for (auto& [records, first, last] : all) {
    first = number;
    while (records.size() < chunk_bytes) {
      const std::string message = scan(encoding, number);
      records += encoding == "cdr" ? mcap_message(1, 25'000'000 * number, message)
                                   : ros1_message(1, static_cast<std::uint32_t>(number), message);
      last = number++;
    }
  }
  return all;
}

/// What a file has to find its way by: connections before all else; an index behind each chunk, as a recorder
/// leaves it that was killed; or nothing, connections being in the first chunk.
enum class Index { whole, of_chunks, none };

std::string mcap_of(const std::string& compression, Index index) {
  const std::string channel = mcap_channel(1, "/scan", "sensor_msgs/LaserScan");
  std::string bytes;
  for (const auto& [records, first, last] : records_of("cdr")) {
    const bool names = index != Index::whole && first == 0;
    bytes += mcap_chunk(
        {25'000'000 * first, 25'000'000 * last, (names ? channel : std::string()) + records, compression});
    if (index == Index::of_chunks) bytes += mcap_message_index(1);
  }
  return mcap_file(bytes, index == Index::whole ? channel : "");
}

std::string ros1_of(const std::string& compression, Index index) {
  const std::string connection = ros1_connection(1, "/scan", "sensor_msgs/LaserScan");
  std::string bytes = ros1_magic + ros1_bag_header(), infos;
  for (const auto& [records, first_number, last_number] : records_of("ros1")) {
    const auto first = static_cast<std::uint32_t>(first_number),
               last = static_cast<std::uint32_t>(last_number);
    infos += ros1_record({{"op", "\x06"},
                          {"chunk_pos", le<std::uint64_t>(bytes.size())},
                          {"start_time", ros1_time(first, 0)},
                          {"end_time", ros1_time(last, 0)}},
                         "");
    bytes += ros1_chunk((first == 0 ? connection : std::string()) + records,
                        compression.empty() ? "none" : compression);
    if (index == Index::of_chunks) bytes += ros1_index(1, first, last);
  }
  return index == Index::whole ? bytes + connection + infos : bytes;
}

void set_rate(benchmark::State& state) {
  state.SetBytesProcessed(static_cast<std::int64_t>(chunks * chunk_bytes) * state.iterations());
}

/// Every message of a file, decoded if `decodes`.
void read(benchmark::State& state, const std::string& content, bool decodes) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("recording", content);
  std::size_t seen = 0;
  for ([[maybe_unused]] auto _ : state) {
    bags::Recording recording(file);
    while (const auto message = recording.next())
      seen += decodes ? bags::read_laser_scan(*message).ranges.size() : message->bytes.size();
  }
  benchmark::DoNotOptimize(seen);
  set_rate(state);
}

void unpack(const std::string& compression, const std::string& packed, std::string& bytes) {
  if (compression == "zstd") {
    ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  } else if (compression == "bz2") {
    auto size = static_cast<unsigned>(bytes.size());
    std::string in = packed;
    BZ2_bzBuffToBuffDecompress(bytes.data(), &size, in.data(), static_cast<unsigned>(in.size()), 0, 0);
  } else {
    LZ4F_dctx* context = nullptr;
    LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
    std::size_t to = bytes.size(), from = packed.size();
    LZ4F_decompress(context, bytes.data(), &to, packed.data(), &from, nullptr);
    LZ4F_freeDecompressionContext(context);
  }
}

/// The same chunks, in memory, unpacked one by one.
void unpack_all(benchmark::State& state, const std::string& encoding, const std::string& compression) {
  std::vector<std::string> packed_chunks;
  for (const Records& records : records_of(encoding))
    packed_chunks.push_back(packed(compression, records.bytes));
  std::string bytes(2 * chunk_bytes, '\0');
  for ([[maybe_unused]] auto _ : state) {
    for (const std::string& chunk : packed_chunks) unpack(compression, chunk, bytes);
  }
  benchmark::DoNotOptimize(bytes);
  set_rate(state);
}

}  // namespace

void register_all() {
  const auto add = [](const std::string& name, auto function) {
    return benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMillisecond);
  };
  struct Format {
    std::string name, encoding;
    std::string (*content)(const std::string& compression, Index index) = nullptr;
    std::vector<std::string> compressions = {};
  };
  for (const Format& format :
       {Format{"mcap", "cdr", mcap_of, {"lz4", "zstd"}}, Format{"ros1", "ros1", ros1_of, {"lz4", "bz2"}}}) {
    const auto read_as = [&](const std::string& compression, Index index, bool decodes) {
      return [=](benchmark::State& state) { read(state, format.content(compression, index), decodes); };
    };
    add("read/" + format.name, read_as("", Index::whole, false));
    add("decode/" + format.name, read_as("", Index::whole, true));
    for (const std::string& compression : format.compressions) {
      const std::string name = format.name + "_" + compression;
      add("unpack/" + name,
          [=](benchmark::State& state) { unpack_all(state, format.encoding, compression); });
      add("read/" + name, read_as(compression, Index::whole, false));
      add("read/" + name + "/index_of_chunks", read_as(compression, Index::of_chunks, false));
      add("read/" + name + "/no_index", read_as(compression, Index::none, false));
    }
  }
}

}  // namespace glocal::bench

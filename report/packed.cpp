#include "report/packed.hpp"

#include <libdeflate.h>

#include <cstddef>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>

#include "evaluation/results/json_text.hpp"

namespace glocal {
namespace {

constexpr int compression_level = 8;  // more takes much longer and saves a hundredth

std::string compressed(std::string_view text) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(compression_level), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string result(libdeflate_zlib_compress_bound(compressor.get(), text.size()), '\0');
  result.resize(
      libdeflate_zlib_compress(compressor.get(), text.data(), text.size(), result.data(), result.size()));
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += digits[three >> shift & 63U];
  }
  // What stands for bytes that are not there.
  for (std::size_t missing = (3 - bytes.size() % 3) % 3; missing > 0; --missing)
    text[text.size() - missing] = '=';
  return text;
}

}  // namespace

std::string packed(const nlohmann::ordered_json& data) {
  return base64(compressed(json_text(data)));
}

}  // namespace glocal

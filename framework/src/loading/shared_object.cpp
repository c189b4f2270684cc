#include "loading/shared_object.hpp"

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "config/text_file.hpp"

namespace glocal {
namespace {

/// The header's machine, as this program was built for.
Elf64_Ehdr own_header() {
  Elf64_Ehdr header{};
  std::ifstream self("/proc/self/exe", std::ios::binary);
  self.read(reinterpret_cast<char*>(&header), sizeof header);
  return header;
}

bool lies_within(std::uint64_t offset, std::uint64_t size, std::uint64_t file_size) {
  return offset <= file_size && size <= file_size - offset;
}

}  // namespace

std::optional<std::string> why_no_shared_object(const std::filesystem::path& file) {
  if (auto why = why_unreadable(file)) return why;
  const auto size = static_cast<std::uint64_t>(std::filesystem::file_size(file));
  std::ifstream in(file, std::ios::binary);
  Elf64_Ehdr header{};
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  constexpr const char* not_one = "not a shared object; a plugin is what glocal_add_plugin() builds (.so)";
  constexpr const char* truncated = "truncated; build or copy it again";
  if (size < sizeof(Elf32_Ehdr) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return not_one;
  if (size < sizeof header) return truncated;
  const Elf64_Ehdr self = own_header();
  if (header.e_ident[EI_CLASS] != self.e_ident[EI_CLASS] || header.e_machine != self.e_machine) {
    return "built for another kind of processor; build it on this one";
  }
  if (header.e_type != ET_DYN) return not_one;

  const std::uint64_t table_size = std::uint64_t{header.e_phnum} * sizeof(Elf64_Phdr);
  if (header.e_phentsize != sizeof(Elf64_Phdr) || !lies_within(header.e_phoff, table_size, size))
    return truncated;
  // The table of sections is the last thing in the file: nothing is missing if it is whole.
  if (!lies_within(header.e_shoff, std::uint64_t{header.e_shnum} * header.e_shentsize, size))
    return truncated;
  std::vector<Elf64_Phdr> segments(header.e_phnum);
  in.seekg(static_cast<std::streamoff>(header.e_phoff));
  in.read(reinterpret_cast<char*>(segments.data()), static_cast<std::streamsize>(table_size));
  if (!in) return truncated;
  for (const Elf64_Phdr& segment : segments) {
    if (!lies_within(segment.p_offset, segment.p_filesz, size)) return truncated;
  }
  return std::nullopt;
}

}  // namespace glocal

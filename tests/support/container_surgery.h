// Damages containers on purpose: puts checksums right again after bytes were changed, so that a test reaches
// the rule behind them. Written against container.md, not against the code in formats/. All of them trust the
// file's fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/container.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

using FileBytes = MemoryFileSystem::Bytes;

// Offsets of fields, from container.md.
inline constexpr std::size_t kHeaderVersionOffset = 8;
inline constexpr std::size_t kHeaderRequiredOffset = 12;
inline constexpr std::size_t kHeaderOptionalOffset = 16;
inline constexpr std::size_t kHeaderReservedOffset = 20;
inline constexpr std::size_t kFooterLengthOffset = 8;  // from the footer's start
inline constexpr std::size_t kFooterIndexOffset = 16;
inline constexpr std::size_t kFooterCountOffset = 24;
inline constexpr std::size_t kFooterIdOffset = 32;

template <typename T>
void store(FileBytes& file, std::size_t offset, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    file.at(offset + i) = static_cast<std::byte>((value >> (8 * i)) & 0xFF);
}

std::size_t footerOffset(const FileBytes& file);
std::size_t indexOffset(const FileBytes& file);
std::uint32_t blockCount(const FileBytes& file);
// Place of the index page and of the index entry of block `number`.
std::size_t indexPageOffset(const FileBytes& file, std::uint32_t number);
std::size_t entryOffset(const FileBytes& file, std::uint32_t number);
BlockLocation entryOf(const FileBytes& file, std::uint32_t number);
// The offset is stored for the first block of a page; those of others follow from the lengths before them.
void storeEntry(FileBytes& file, std::uint32_t number, const BlockLocation& entry);

void sealHeader(FileBytes& file);
void sealFooter(FileBytes& file);
// Page checksums only; the entries stay as they are.
void sealIndexPages(FileBytes& file);
// Everything that depends on payloads: block checksums, pages, and, unless `keep_id`, the file's identity;
// then the footer.
void sealAll(FileBytes& file, bool keep_id = false);

std::vector<std::byte> payloadOf(const FileBytes& file, std::uint32_t number);
// A whole container of the given payloads, all of one type.
FileBytes makeContainer(ContentKind kind, BlockType type,
                        const std::vector<std::vector<std::byte>>& payloads);

// The identity a reader would find: length and the id in the footer.
FileIdentity identityOf(const FileBytes& file);

}  // namespace deltaz

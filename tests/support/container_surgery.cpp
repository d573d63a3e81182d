#include "tests/support/container_surgery.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "formats/bytes.h"

namespace deltaz {
namespace {

Hash128 idOf(const FileBytes& file) {
  Hash128 id;
  std::copy_n(file.begin() + static_cast<std::ptrdiff_t>(footerOffset(file) + kFooterIdOffset),
              id.bytes.size(), id.bytes.begin());
  return id;
}

std::uint64_t payloadHash(const FileBytes& file, const BlockLocation& entry) {
  return hash64(std::span(file).subspan(entry.offset, entry.length));
}

}  // namespace

std::size_t footerOffset(const FileBytes& file) {
  return file.size() - kContainerFooterBytes;
}

std::size_t indexOffset(const FileBytes& file) {
  return loadLittleEndian<std::uint64_t>(file, footerOffset(file) + kFooterIndexOffset);
}

std::uint32_t blockCount(const FileBytes& file) {
  return loadLittleEndian<std::uint32_t>(file, footerOffset(file) + kFooterCountOffset);
}

std::size_t indexPageOffset(const FileBytes& file, std::uint32_t number) {
  return indexOffset(file) + number / kIndexEntriesPerPage * kIndexPageBytes;
}

std::size_t entryOffset(const FileBytes& file, std::uint32_t number) {
  return indexPageOffset(file, number) + 8 + number % kIndexEntriesPerPage * kIndexEntryBytes;
}

BlockLocation entryOf(const FileBytes& file, std::uint32_t number) {
  const std::span<const std::byte> bytes(file);
  const auto lengthOf = [&](std::uint32_t block) {
    return loadLittleEndian<std::uint32_t>(bytes, entryOffset(file, block));
  };
  BlockLocation entry;
  // Only the first block of a page says where it lies.
  entry.offset = loadLittleEndian<std::uint64_t>(bytes, indexPageOffset(file, number));
  const auto first = static_cast<std::uint32_t>(number - number % kIndexEntriesPerPage);
  for (std::uint32_t before = first; before < number; ++before)
    entry.offset += (lengthOf(before) + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
  ByteReader reader(bytes.subspan(entryOffset(file, number), kIndexEntryBytes));
  entry.length = reader.get<std::uint32_t>();
  entry.type = static_cast<BlockType>(reader.get<std::uint32_t>());
  entry.checksum = reader.get<std::uint64_t>();
  return entry;
}

void storeEntry(FileBytes& file, std::uint32_t number, const BlockLocation& entry) {
  if (number % kIndexEntriesPerPage == 0) store(file, indexPageOffset(file, number), entry.offset);
  const std::size_t offset = entryOffset(file, number);
  store(file, offset, entry.length);
  store(file, offset + 4, static_cast<std::uint32_t>(entry.type));
  store(file, offset + 8, entry.checksum);
}

void sealHeader(FileBytes& file) {
  store(file, 24, hash64(std::span(file).first(24)));
}

void sealFooter(FileBytes& file) {
  const std::size_t footer = footerOffset(file);
  store(file, footer + 72, hash64(std::span(file).subspan(footer, 72)));
}

void sealIndexPages(FileBytes& file) {
  const Hash128 id = idOf(file);
  for (std::uint32_t first = 0; first < blockCount(file); first += kIndexEntriesPerPage) {
    const std::size_t offset = indexPageOffset(file, first);
    const std::size_t entries = std::min<std::size_t>(kIndexEntriesPerPage, blockCount(file) - first);
    const std::size_t summed = 8 + entries * kIndexEntryBytes;
    ByteWriter writer;
    writer.putBytes(std::span(file).subspan(offset, summed));
    writer.putBytes(id.bytes);
    writer.put(static_cast<std::uint64_t>(offset));
    store(file, offset + summed, hash64(writer.view()));
  }
}

void sealAll(FileBytes& file, bool keep_id) {
  if (!keep_id) {
    ByteWriter hashes;
    for (std::uint32_t number = 0; number < blockCount(file); ++number) {
      hashes.put(payloadHash(file, entryOf(file, number)));
    }
    const Hash128 id = hash128(hashes.view());
    std::copy(id.bytes.begin(), id.bytes.end(),
              file.begin() + static_cast<std::ptrdiff_t>(footerOffset(file) + kFooterIdOffset));
  }
  const Hash128 id = idOf(file);
  for (std::uint32_t number = 0; number < blockCount(file); ++number) {
    BlockLocation entry = entryOf(file, number);
    ByteWriter writer;
    writer.put(payloadHash(file, entry));
    writer.putBytes(id.bytes);
    writer.put(entry.offset);
    writer.put(entry.length);
    writer.put(static_cast<std::uint32_t>(entry.type));
    entry.checksum = hash64(writer.view());
    storeEntry(file, number, entry);
  }
  sealIndexPages(file);
  sealFooter(file);
}

std::vector<std::byte> payloadOf(const FileBytes& file, std::uint32_t number) {
  const BlockLocation entry = entryOf(file, number);
  const auto payload = std::span(file).subspan(entry.offset, entry.length);
  return {payload.begin(), payload.end()};
}

FileBytes makeContainer(ContentKind kind, BlockType type,
                        const std::vector<std::vector<std::byte>>& payloads) {
  const MemoryFileSystem files;
  auto writer = ContainerWriter::create(files, "file", kind);
  if (!writer.ok()) throw std::runtime_error(writer.error().message());
  for (const auto& payload : payloads) {
    if (const auto number = writer.value().append(type, payload); !number.ok()) {
      throw std::runtime_error(number.error().message());
    }
  }
  if (const auto identity = writer.value().finish(); !identity.ok())
    throw std::runtime_error(identity.error().message());
  return files.bytes("file");
}

FileIdentity identityOf(const FileBytes& file) {
  return {file.size(), idOf(file)};
}

}  // namespace deltaz

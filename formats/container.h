// The container every binary file of a database is: a header, blocks, an index of the blocks in pages, a
// footer. The bytes are specified in container.md. Every byte of the file is under a checksum or must be
// zero.
//
// Guarantees of the reader: a block is handed out only if its checksum, which covers its payload, the file's
// identity and the block's own offset, holds; counts are checked against the file's length before anything is
// allocated. Errors: kInvalid with a HDR_, IDX_ or SUM_ code; kNewerFormat for an unknown version or required
// feature.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/file_system.h"
#include "formats/hash.h"

namespace deltaz {

inline constexpr std::array<std::uint8_t, 8> kContainerMagic = {0x89, 'D', 'L', 'Z', '\r', '\n', 0x1A, '\n'};
inline constexpr std::array<std::uint8_t, 8> kFooterMagic = {'D', 'L', 'Z', 'f', 'o', 'o', 't', '\n'};
inline constexpr std::uint16_t kContainerVersion = 2;  // version 1 had other index pages, and is read too
inline constexpr std::size_t kContainerHeaderBytes = 32;
inline constexpr std::size_t kContainerFooterBytes = 80;
// A view wants a few blocks here and there: small pages cost it little.
inline constexpr std::size_t kIndexEntryBytes = 16;
inline constexpr std::size_t kIndexEntriesPerPage = 8;
inline constexpr std::size_t kIndexPageFrameBytes = 16;  // the first block's offset, and the checksum
inline constexpr std::size_t kIndexPageBytes = kIndexEntryBytes * kIndexEntriesPerPage + kIndexPageFrameBytes;
inline constexpr std::size_t kBlockAlignment = 8;
inline constexpr std::uint32_t kMaximumBlockBytes = 1u << 30;

// What the blocks of a file are.
enum class ContentKind : std::uint16_t {
  kNodes = 1,
  kTerrain = 2,
  kPatches = 3,
  kSeams = 4,
  kColors = 5,
  kModel = 6,
  kPlacements = 7
};

// What one block is; stored in the index, append-only.
enum class BlockType : std::uint32_t {
  kNodePage = 1,
  kTerrainNode = 2,
  kPatchRow = 3,
  kSeam = 4,
  kColorTile = 5,
  kColorPage = 6,
  kColorDirectory = 7,
  kModelMesh = 8,
  kModelTree = 9,
  kPlacementPage = 10,
  kPlacementDirectory = 11,
  kPackedNodePage = 12
};

struct BlockLocation {
  std::uint64_t offset = 0;  // of the payload from the start of the file, bytes
  std::uint32_t length = 0;  // of the payload, bytes
  BlockType type = BlockType::kNodePage;
  std::uint64_t checksum = 0;  // blockChecksum of what follows
};

// The checksum stored for a block: XXH3-64 over the hash of its payload, the file id, and where and what it
// is.
std::uint64_t blockChecksum(std::uint64_t payload_hash, const Hash128& file_id, std::uint64_t offset,
                            std::uint32_t length, BlockType type);

// What identifies a finished file.
struct FileIdentity {
  std::uint64_t length = 0;
  Hash128 id;  // XXH3-128 over the hashes of all payloads, in order
};

// Writes a container front to back. Thread-safety: one thread.
class ContainerWriter {
 public:
  static Result<ContainerWriter> create(const FileSystem& files, const std::string& path, ContentKind kind);
  // Appends a block and returns its number, counted from 0. `payload` at most kMaximumBlockBytes.
  Result<std::uint32_t> append(BlockType type, std::span<const std::byte> payload);
  // Bytes written so far.
  std::uint64_t size() const { return position_; }
  // Writes index and footer, syncs and closes. Nothing may follow.
  Result<FileIdentity> finish();

 private:
  ContainerWriter(std::unique_ptr<WritableFile> file, ContentKind kind);
  Status write(std::span<const std::byte> bytes);
  Status pad();

  std::unique_ptr<WritableFile> file_;
  ContentKind kind_;
  std::uint64_t position_ = 0;
  std::vector<BlockLocation> blocks_;  // checksum holds the payload's hash until finish()
};

// Opens a container, and reads and verifies its blocks on demand. Thread-safety: all const members from any
// thread.
class ContainerReader {
 public:
  // Reads header and footer only, of any version up to kContainerVersion. `path` is used in messages.
  static Result<ContainerReader> open(const FileSystem& files, const std::string& path, ContentKind kind);

  std::uint32_t blockCount() const { return block_count_; }
  const FileIdentity& identity() const { return identity_; }
  const std::string& path() const { return path_; }
  std::uint32_t optionalFeatures() const { return optional_features_; }

  // Where block `number` lies (reads its index page once). kIdxOrder if it lies outside the file's block
  // region.
  Result<BlockLocation> locate(std::uint32_t number) const;
  // The verified payload of block `number`, which must be of type `type`.
  Result<std::vector<std::byte>> read(std::uint32_t number, BlockType type) const;

  // Bytes read from the file so far, index and footer included.
  std::uint64_t bytesRead() const;

  // For dbcheck: what a reader of single blocks does not need to look at. Each returns the first thing wrong.
  // The blocks follow each other without gap or overlap up to the index.
  Status checkIndex() const;
  // The bytes between blocks are zero.
  Status checkPadding() const;
  // The file id follows from the payloads (reads every block, whether its checksum holds or not).
  Status checkFileId() const;

 private:
  // How the index of a version is laid out.
  struct IndexLayout {
    std::size_t entry_bytes = kIndexEntryBytes;
    std::size_t entries_per_page = kIndexEntriesPerPage;
    std::size_t frame_bytes = kIndexPageFrameBytes;
    bool offset_in_entry = false;  // or only the first one, before the entries
  };

  ContainerReader() = default;
  Result<std::vector<std::byte>> readBytes(std::uint64_t offset, std::uint64_t length) const;
  Result<std::vector<BlockLocation>> readIndexPage(std::size_t page_number, std::size_t entries,
                                                   std::uint64_t& bytes_read) const;

  std::string path_;
  std::unique_ptr<ReadableFile> file_;
  FileIdentity identity_;
  std::uint32_t block_count_ = 0;
  std::uint32_t optional_features_ = 0;
  std::uint64_t index_offset_ = 0;
  IndexLayout index_;
  // What is learnt while reading; shared by all threads.
  struct Cache {
    std::mutex mutex;
    std::vector<std::vector<BlockLocation>> pages;
    std::uint64_t bytes_read = 0;
  };
  std::unique_ptr<Cache> cache_;
};

}  // namespace deltaz

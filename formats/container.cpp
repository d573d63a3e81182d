#include "formats/container.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::uint32_t kKnownRequiredFeatures = 0;
constexpr std::uint16_t kVersionOfWholeEntries = 1;  // entries of 24 bytes, 128 to a page
constexpr std::size_t kFooterChecksumOffset = kContainerFooterBytes - 8;
constexpr std::size_t kHeaderChecksumOffset = kContainerHeaderBytes - 8;

std::uint64_t roundUpToAlignment(std::uint64_t position) {
  return (position + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
}

std::uint64_t pageChecksum(std::span<const std::byte> entries, const Hash128& file_id, std::uint64_t offset) {
  ByteWriter writer;
  writer.putBytes(entries);
  writer.putBytes(file_id.bytes);
  writer.put(offset);
  return hash64(writer.view());
}

template <std::size_t count>
void putMagic(ByteWriter& writer, const std::array<std::uint8_t, count>& magic) {
  for (const std::uint8_t byte : magic) writer.put(byte);
}

template <std::size_t count>
bool hasMagic(std::span<const std::byte> bytes, const std::array<std::uint8_t, count>& magic) {
  return std::equal(magic.begin(), magic.end(), bytes.begin(),
                    [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
}

bool allZero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

const char* const kDamaged = "The file is damaged; restore it or rebuild the database";

Status checkHeader(std::span<const std::byte> header, ContentKind kind, const std::string& path,
                   std::uint16_t& version, std::uint32_t& optional_features) {
  if (!hasMagic(header, kContainerMagic)) {
    return invalidError(IssueCode::kHdrMagic, path, "this is not a deltaz file",
                        "its first bytes are not the magic number");
  }
  if (loadLittleEndian<std::uint64_t>(header, kHeaderChecksumOffset) !=
      hash64(header.first(kHeaderChecksumOffset))) {
    return invalidError(IssueCode::kHdrChecksum, path, "the header does not match its checksum", {},
                        kDamaged);
  }
  version = loadLittleEndian<std::uint16_t>(header, 8);
  if (version > kContainerVersion) {
    return newerFormatError(
        IssueCode::kHdrVersionNewer, path,
        fmt::format("container version {} is newer than this program knows ({})", version, kContainerVersion),
        "Use a newer deltaz");
  }
  const auto required = loadLittleEndian<std::uint32_t>(header, 12);
  if ((required & ~kKnownRequiredFeatures) != 0) {
    return newerFormatError(
        IssueCode::kHdrFeatureUnknown, path,
        fmt::format("the file needs features this program does not have (bits {:#x})", required),
        "Use a newer deltaz");
  }
  if (version == 0 || loadLittleEndian<std::uint16_t>(header, 10) != static_cast<std::uint16_t>(kind) ||
      loadLittleEndian<std::uint32_t>(header, 20) != 0) {
    return invalidError(IssueCode::kHdrField, path,
                        "the header's version, kind or reserved field has a wrong value", {}, kDamaged);
  }
  optional_features = loadLittleEndian<std::uint32_t>(header, 16);
  return Success{};
}

}  // namespace

std::uint64_t blockChecksum(std::uint64_t payload_hash, const Hash128& file_id, std::uint64_t offset,
                            std::uint32_t length, BlockType type) {
  ByteWriter writer;
  writer.put(payload_hash);
  writer.putBytes(file_id.bytes);
  writer.put(offset);
  writer.put(length);
  writer.put(static_cast<std::uint32_t>(type));
  return hash64(writer.view());
}

// ---- writing

ContainerWriter::ContainerWriter(std::unique_ptr<WritableFile> file, ContentKind kind)
    : file_(std::move(file)), kind_(kind) {}

Result<ContainerWriter> ContainerWriter::create(const FileSystem& files, const std::string& path,
                                                ContentKind kind) {
  DELTAZ_TRY_ASSIGN(std::unique_ptr<WritableFile> file, files.create(path));
  ContainerWriter writer(std::move(file), kind);
  ByteWriter header;
  putMagic(header, kContainerMagic);
  header.put(kContainerVersion);
  header.put(static_cast<std::uint16_t>(kind));
  header.putZeros(12);
  header.put(hash64(header.view()));
  DELTAZ_TRY(writer.write(header.view()));
  return writer;
}

Status ContainerWriter::write(std::span<const std::byte> bytes) {
  DELTAZ_TRY(file_->append(bytes));
  position_ += bytes.size();
  return Success{};
}

Status ContainerWriter::pad() {
  static constexpr std::array<std::byte, kBlockAlignment> kZeros{};
  return write(std::span(kZeros).first(roundUpToAlignment(position_) - position_));
}

Result<std::uint32_t> ContainerWriter::append(BlockType type, std::span<const std::byte> payload) {
  assert(!payload.empty() && payload.size() <= kMaximumBlockBytes);
  const auto number = static_cast<std::uint32_t>(blocks_.size());
  blocks_.push_back({position_, static_cast<std::uint32_t>(payload.size()), type, hash64(payload)});
  DELTAZ_TRY(write(payload));
  DELTAZ_TRY(pad());
  return number;
}

Result<FileIdentity> ContainerWriter::finish() {
  ByteWriter payload_hashes;
  for (const BlockLocation& block : blocks_) payload_hashes.put(block.checksum);
  const Hash128 file_id = hash128(payload_hashes.view());
  const std::uint64_t index_offset = position_;
  for (std::size_t first = 0; first < blocks_.size(); first += kIndexEntriesPerPage) {
    ByteWriter page;
    const std::size_t end = std::min(blocks_.size(), first + kIndexEntriesPerPage);
    page.put(blocks_[first].offset);
    for (std::size_t i = first; i < end; ++i) {
      const BlockLocation& block = blocks_[i];
      page.put(block.length);
      page.put(static_cast<std::uint32_t>(block.type));
      page.put(blockChecksum(block.checksum, file_id, block.offset, block.length, block.type));
    }
    page.put(pageChecksum(page.view(), file_id, position_));
    DELTAZ_TRY(write(page.view()));
  }
  const std::uint64_t length = position_ + kContainerFooterBytes;
  ByteWriter footer;
  putMagic(footer, kFooterMagic);
  footer.put(length);
  footer.put(index_offset);
  footer.put(static_cast<std::uint32_t>(blocks_.size()));
  footer.put(static_cast<std::uint16_t>(kind_));
  footer.put(kContainerVersion);
  footer.putBytes(file_id.bytes);
  footer.putZeros(kFooterChecksumOffset - footer.size());
  footer.put(hash64(footer.view()));
  DELTAZ_TRY(write(footer.view()));
  DELTAZ_TRY(file_->sync());
  DELTAZ_TRY(file_->close());
  return FileIdentity{length, file_id};
}

// ---- reading

Result<std::vector<std::byte>> ContainerReader::readBytes(std::uint64_t offset, std::uint64_t length) const {
  std::vector<std::byte> bytes(length);
  DELTAZ_TRY(file_->readAt(offset, bytes));
  const std::lock_guard guard(cache_->mutex);
  cache_->bytes_read += length;
  return bytes;
}

Result<ContainerReader> ContainerReader::open(const FileSystem& files, const std::string& path,
                                              ContentKind kind) {
  ContainerReader reader;
  reader.path_ = path;
  reader.cache_ = std::make_unique<Cache>();
  DELTAZ_TRY_ASSIGN(reader.file_, files.open(path));
  const std::uint64_t length = reader.file_->size();
  if (length < kContainerHeaderBytes + kContainerFooterBytes) {
    return invalidError(IssueCode::kHdrLength, path, fmt::format("the file is too short ({} bytes)", length),
                        {}, kDamaged);
  }
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> header, reader.readBytes(0, kContainerHeaderBytes));
  std::uint16_t version = 0;
  DELTAZ_TRY(checkHeader(header, kind, path, version, reader.optional_features_));
  if (version == kVersionOfWholeEntries) reader.index_ = {24, 128, 8, true};
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> footer,
                    reader.readBytes(length - kContainerFooterBytes, kContainerFooterBytes));
  const std::span<const std::byte> bytes(footer);
  if (!hasMagic(bytes, kFooterMagic) || loadLittleEndian<std::uint64_t>(bytes, kFooterChecksumOffset) !=
                                            hash64(bytes.first(kFooterChecksumOffset))) {
    return invalidError(IssueCode::kHdrFooter, path, "the file does not end in a valid footer",
                        "it was cut short, added to, or never finished", kDamaged);
  }
  ByteReader fields(bytes.subspan(kFooterMagic.size()));
  const auto stated_length = fields.get<std::uint64_t>();
  reader.index_offset_ = fields.get<std::uint64_t>();
  reader.block_count_ = fields.get<std::uint32_t>();
  const auto stated_kind = fields.get<std::uint16_t>();
  const auto stated_version = fields.get<std::uint16_t>();
  reader.identity_.length = length;
  std::copy_n(bytes.begin() + 32, reader.identity_.id.bytes.size(), reader.identity_.id.bytes.begin());
  if (stated_length != length) {
    return invalidError(IssueCode::kHdrLength, path,
                        fmt::format("the file has {} bytes, its footer says {}", length, stated_length), {},
                        kDamaged);
  }
  // Counts are compared with what the file can hold before they size anything.
  const IndexLayout& index = reader.index_;
  const std::uint64_t pages =
      (static_cast<std::uint64_t>(reader.block_count_) + index.entries_per_page - 1) / index.entries_per_page;
  const std::uint64_t index_bytes =
      static_cast<std::uint64_t>(reader.block_count_) * index.entry_bytes + pages * index.frame_bytes;
  const std::uint64_t index_end = length - kContainerFooterBytes;
  if (stated_kind != static_cast<std::uint16_t>(kind) || stated_version != version ||
      !allZero(bytes.subspan(48, kFooterChecksumOffset - 48)) ||
      reader.index_offset_ < kContainerHeaderBytes || reader.index_offset_ % kBlockAlignment != 0 ||
      index_bytes > index_end || reader.index_offset_ != index_end - index_bytes) {
    return invalidError(IssueCode::kHdrField, path, "the footer's fields do not fit the file", {}, kDamaged);
  }
  reader.cache_->pages.resize(pages);
  return reader;
}

Result<BlockLocation> ContainerReader::locate(std::uint32_t number) const {
  if (number >= block_count_) {
    return invalidError(IssueCode::kRefData, path_,
                        fmt::format("there is no block {}; the file has {}", number, block_count_));
  }
  const std::size_t page_number = number / index_.entries_per_page;
  const std::size_t slot = number % index_.entries_per_page;
  {
    const std::lock_guard guard(cache_->mutex);
    const std::vector<BlockLocation>& page = cache_->pages[page_number];
    if (!page.empty()) return page[slot];
  }
  const std::size_t entries =
      std::min<std::size_t>(index_.entries_per_page, block_count_ - page_number * index_.entries_per_page);
  std::uint64_t bytes_read = 0;
  DELTAZ_TRY_ASSIGN(const std::vector<BlockLocation> page, readIndexPage(page_number, entries, bytes_read));
  const std::lock_guard guard(cache_->mutex);
  // Threads that want a page at the same time all read it; the count must not tell how many they were.
  if (!cache_->pages[page_number].empty()) cache_->bytes_read -= bytes_read;
  cache_->pages[page_number] = page;
  return page[slot];
}

Result<std::vector<BlockLocation>> ContainerReader::readIndexPage(std::size_t page_number,
                                                                  std::size_t entries,
                                                                  std::uint64_t& bytes_read) const {
  const std::uint64_t full_page_bytes = index_.entries_per_page * index_.entry_bytes + index_.frame_bytes;
  const std::uint64_t offset = index_offset_ + page_number * full_page_bytes;
  bytes_read = entries * index_.entry_bytes + index_.frame_bytes;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readBytes(offset, bytes_read));
  const std::span<const std::byte> view(bytes);
  const std::span<const std::byte> body = view.first(bytes.size() - 8);
  if (loadLittleEndian<std::uint64_t>(view, body.size()) != pageChecksum(body, identity_.id, offset)) {
    return invalidError(IssueCode::kIdxChecksum, path_,
                        fmt::format("index page {} does not match its checksum", page_number), {}, kDamaged);
  }
  std::vector<BlockLocation> page;
  ByteReader fields(body);
  // Blocks follow each other: the first one's offset and the lengths say where each lies.
  std::uint64_t expected = page_number == 0 ? kContainerHeaderBytes : 0;
  std::uint64_t next = index_.offset_in_entry ? 0 : fields.get<std::uint64_t>();
  for (std::size_t i = 0; i < entries; ++i) {
    BlockLocation block;
    block.offset = index_.offset_in_entry ? fields.get<std::uint64_t>() : next;
    block.length = fields.get<std::uint32_t>();
    block.type = static_cast<BlockType>(fields.get<std::uint32_t>());
    block.checksum = fields.get<std::uint64_t>();
    const std::size_t number = page_number * index_.entries_per_page + i;
    if (block.offset < kContainerHeaderBytes || block.offset > index_offset_ || block.length == 0 ||
        block.length > kMaximumBlockBytes || block.length > index_offset_ - block.offset ||
        block.offset % kBlockAlignment != 0) {
      return invalidError(IssueCode::kIdxOrder, path_,
                          fmt::format("block {} lies outside the file's blocks", number), {}, kDamaged);
    }
    // Two whole entries exchanged would hand out two intact blocks as each other.
    if (expected != 0 && block.offset != expected) {
      return invalidError(IssueCode::kIdxOrder, path_,
                          fmt::format("block {} does not follow the one before it", number), {}, kDamaged);
    }
    expected = next = roundUpToAlignment(block.offset + block.length);
    page.push_back(block);
  }
  return page;
}

Result<std::vector<std::byte>> ContainerReader::read(std::uint32_t number, BlockType type) const {
  DELTAZ_TRY_ASSIGN(const BlockLocation block, locate(number));
  if (block.type != type) {
    return invalidError(
        IssueCode::kRefData, path_,
        fmt::format("block {} is of type {}, not {}", number, static_cast<std::uint32_t>(block.type),
                    static_cast<std::uint32_t>(type)));
  }
  DELTAZ_TRY_ASSIGN(std::vector<std::byte> payload, readBytes(block.offset, block.length));
  if (blockChecksum(hash64(payload), identity_.id, block.offset, block.length, block.type) !=
      block.checksum) {
    return invalidError(IssueCode::kSumBlock, path_,
                        fmt::format("block {} (bytes {} to {}) does not match its checksum", number,
                                    block.offset, block.offset + block.length - 1),
                        {}, kDamaged);
  }
  return payload;
}

std::uint64_t ContainerReader::bytesRead() const {
  const std::lock_guard guard(cache_->mutex);
  return cache_->bytes_read;
}

Status ContainerReader::checkIndex() const {
  std::uint64_t expected = kContainerHeaderBytes;
  for (std::uint32_t number = 0; number < block_count_; ++number) {
    DELTAZ_TRY_ASSIGN(const BlockLocation block, locate(number));
    if (block.offset != expected) {
      return invalidError(IssueCode::kIdxOrder, path_,
                          fmt::format("block {} begins at byte {}, not where the one before it ends ({})",
                                      number, block.offset, expected),
                          {}, kDamaged);
    }
    expected = roundUpToAlignment(block.offset + block.length);
  }
  if (expected != index_offset_) {
    return invalidError(
        IssueCode::kIdxOrder, path_,
        fmt::format("the blocks end at byte {}, the index begins at {}", expected, index_offset_), {},
        kDamaged);
  }
  return Success{};
}

Status ContainerReader::checkPadding() const {
  for (std::uint32_t number = 0; number < block_count_; ++number) {
    DELTAZ_TRY_ASSIGN(const BlockLocation block, locate(number));
    const std::uint64_t end = block.offset + block.length;
    const std::uint64_t padding = roundUpToAlignment(end) - end;
    if (padding == 0 || end + padding > index_offset_) continue;
    DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readBytes(end, padding));
    if (!allZero(bytes)) {
      return invalidError(IssueCode::kSumPadding, path_,
                          fmt::format("the padding after block {} (byte {}) is not zero", number, end), {},
                          kDamaged);
    }
  }
  return Success{};
}

Status ContainerReader::checkFileId() const {
  ByteWriter payload_hashes;
  for (std::uint32_t number = 0; number < block_count_; ++number) {
    DELTAZ_TRY_ASSIGN(const BlockLocation block, locate(number));
    DELTAZ_TRY_ASSIGN(const std::vector<std::byte> payload, readBytes(block.offset, block.length));
    payload_hashes.put(hash64(payload));
  }
  if (hash128(payload_hashes.view()) != identity_.id) {
    return invalidError(IssueCode::kSumFileId, path_, "the file's identity does not follow from its contents",
                        {}, kDamaged);
  }
  return Success{};
}

}  // namespace deltaz

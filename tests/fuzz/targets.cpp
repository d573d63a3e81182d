#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/delta_codec.h"
#include "formats/node_file.h"
#include "formats/terrain_segment.h"
#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

constexpr std::uint32_t kLeafCells = 64;

void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

const MemoryFileSystem& soundDatabase() {
  static const MemoryFileSystem files = [] {
    SyntheticGridOptions options;
    options.columns = 21;
    options.rows = 19;
    options.voids = VoidPattern::kSingle;
    BuildOptions build;
    build.leaf_cells = 8;
    return buildInMemory(syntheticGrid(options), build);
  }();
  return files;
}

DatabaseEditor soundEditor() {
  MemoryFileSystem files = soundDatabase();
  return DatabaseEditor(files, kMemoryDatabasePath);
}

std::string textOf(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text.push_back(static_cast<char>(byte));
  return text;
}

FuzzInput inputOf(std::uint8_t first, std::span<const std::byte> rest) {
  FuzzInput input;
  input.reserve(rest.size() + 1);
  input.push_back(std::byte{first});
  for (const std::byte byte : rest) input.push_back(byte);
  return input;
}

// ---- container: the first byte says what to seal

constexpr std::uint8_t kSealHeader = 1, kSealFooter = 2, kSealIndex = 4, kSealAll = 7;

bool indexFits(const FileBytes& file) {
  const std::uint64_t index = indexOffset(file), blocks = blockCount(file);
  const std::uint64_t pages = (blocks + kIndexEntriesPerPage - 1) / kIndexEntriesPerPage;
  return index <= footerOffset(file) && blocks * kIndexEntryBytes + pages * 8 <= footerOffset(file) - index;
}

void fuzzContainer(std::span<const std::byte> input) {
  if (input.empty()) return;
  const auto seal = std::to_integer<std::uint8_t>(input[0]);
  FileBytes file(input.begin() + 1, input.end());
  if (file.size() >= kContainerHeaderBytes + kContainerFooterBytes) {
    if ((seal & kSealHeader) != 0) sealHeader(file);
    if ((seal & kSealIndex) != 0 && indexFits(file)) sealIndexPages(file);
    if ((seal & kSealFooter) != 0) sealFooter(file);
  }
  MemoryFileSystem files;
  files.setBytes("file", file);
  for (const ContentKind kind : {ContentKind::kNodes, ContentKind::kTerrain}) {
    const auto container = ContainerReader::open(files, "file", kind);
    if (!container.ok()) continue;
    promise(container.value().blockCount() <= file.size() / kIndexEntryBytes,
            "the block count fits the file");
    bool sound = container.value().checkIndex().ok();
    sound = container.value().checkPadding().ok() && sound;
    sound = container.value().checkFileId().ok() && sound;
    for (std::uint32_t number = 0; number < container.value().blockCount(); ++number) {
      const auto location = container.value().locate(number);
      promise(location.ok() || !sound, "a sound index has all blocks");
      if (location.ok()) (void)container.value().read(number, location.value().type);
    }
    promise(!container.value().locate(container.value().blockCount()).ok(),
            "there is no block past the last");
  }
}

std::vector<FuzzInput> containerSeeds() {
  const DatabaseEditor editor = soundEditor();
  std::vector<FuzzInput> seeds;
  for (const std::string& path : {editor.nodePath(), editor.terrainPath()}) {
    for (const std::uint8_t seal : {std::uint8_t{0}, kSealAll}) {
      seeds.push_back(inputOf(seal, soundDatabase().bytes(path)));
    }
  }
  seeds.push_back(inputOf(kSealAll, makeContainer(ContentKind::kTerrain, BlockType::kTerrainNode, {})));
  return seeds;
}

// ---- area.json: an odd first byte asks for the right hash

void fuzzArea(std::span<const std::byte> input) {
  if (input.empty()) return;
  std::string text = textOf(input.subspan(1));
  if ((std::to_integer<unsigned>(input[0]) & 1) != 0 && text.find(",\n  \"hash\": \"") != std::string::npos) {
    text = sealAreaText(text);
  }
  const auto area = parseArea(text, "area.json");
  if (!area.ok()) return;
  promise(serializeArea(area.value()) == text, "what is read is canonical");
  for (const GridHeader& header : area.value().grids) {
    const GridGeometry geometry(header);
    for (int level = 0; level < header.level_count; ++level) {
      const PostRange posts = geometry.columnsAt(level), nodes = geometry.nodeColumnsAt(level);
      promise(nodes.size() >= 1, "an area has a node of every level");
      promise(posts.size() <= header.x_axis.count, "no level has more posts than the finest");
    }
  }
}

std::vector<FuzzInput> areaSeeds() {
  const auto& bytes = soundDatabase().bytes(soundEditor().areaPath());
  return {inputOf(0, bytes), inputOf(1, bytes)};
}

// ---- a page of node records

void fuzzNodePage(std::span<const std::byte> input) {
  const auto records = decodeNodePage(input, "page");
  if (!records.ok()) return;
  const auto bytes = encodeNodePage(records.value());
  promise(bytes.size() == input.size() && std::equal(bytes.begin(), bytes.end(), input.begin()),
          "a page has one form");
}

std::vector<FuzzInput> nodePageSeeds() {
  const auto& nodes = soundDatabase().bytes(soundEditor().nodePath());
  const std::vector<std::byte> page = payloadOf(nodes, 0);
  return {page, FuzzInput(page.begin(), page.begin() + kNodeRecordBytes)};
}

// ---- a terrain block, and the codec inside it

void fuzzTerrainBlock(std::span<const std::byte> input) {
  const auto block = decodeTerrainBlock(input, kLeafCells, "block");
  if (!block.ok()) return;
  const TerrainBlock& first = block.value();
  const std::size_t posts = (first.columns + std::size_t{2}) * (first.rows + std::size_t{2});
  promise(first.heights.size() == posts && first.valid.size() == posts,
          "arrays have the shape the header states");
  promise(first.columns <= kLeafCells + 1 && first.rows <= kLeafCells + 1,
          "no more posts than a node can have");
  const auto again = decodeTerrainBlock(encodeTerrainBlock(first), kLeafCells, "block");
  promise(again.ok(), "what was decoded can be encoded");
  promise(again.value().valid == first.valid && again.value().ancestors == first.ancestors,
          "voids and errors survive");
  for (std::size_t i = 0; i < posts; ++i) {
    promise(first.valid[i] == 0 || again.value().heights[i] == first.heights[i], "heights survive");
  }
}

std::vector<FuzzInput> terrainBlockSeeds() {
  const DatabaseEditor editor = soundEditor();
  std::vector<FuzzInput> seeds(editor.payloads.begin(), editor.payloads.begin() + 4);
  seeds.push_back(editor.payloads.back());
  return seeds;
}

// The first two bytes are columns and rows, the rest a packed array.
void fuzzCodec(std::span<const std::byte> input) {
  if (input.size() < 2) return;
  const std::uint32_t columns = std::to_integer<std::uint32_t>(input[0]) % 67 + 1;
  const std::uint32_t rows = std::to_integer<std::uint32_t>(input[1]) % 67 + 1;
  const auto array = unpackHeights(input.subspan(2), DeltaPacking::kPlanes, columns, rows, "array");
  if (!array.ok()) return;
  const std::size_t posts = std::size_t{columns} * rows;
  promise(array.value().heights.size() == posts && array.value().valid.size() == posts,
          "the shape is the one asked for");
  const auto sums = sumsOf(array.value().heights, columns, rows);
  promise(sums.size() == posts, "sums keep the shape");
}

std::vector<FuzzInput> codecSeeds() {
  HeightArray array;
  array.columns = 7;
  array.rows = 5;
  for (int i = 0; i < 35; ++i) {
    array.heights.push_back(i * i * 31 % 977 - 100);
    array.valid.push_back(i % 11 == 0 ? 0 : 1);
  }
  fillVoids(array);
  FuzzInput input = inputOf(6, inputOf(4, packHeights(array, DeltaPacking::kPlanes)));
  return {input};
}

// ---- a whole database: the input is a list of edits of four bytes (file, place, place, value), sealed
// afterwards

constexpr std::size_t kEditBytes = 4;

void editPayloads(FileBytes& file, std::size_t place, std::byte value) {
  const std::size_t begin = kContainerHeaderBytes, end = indexOffset(file);
  file[begin + place % (end - begin)] = value;
}

void fuzzDatabase(std::span<const std::byte> input) {
  MemoryFileSystem files = soundDatabase();
  DatabaseEditor editor(files, kMemoryDatabasePath);
  FileBytes& nodes = files.mutableBytes(editor.nodePath());
  FileBytes& terrain = files.mutableBytes(editor.terrainPath());
  std::vector<std::pair<std::size_t, std::byte>> area_edits;
  for (std::size_t i = 0; i + kEditBytes <= std::min<std::size_t>(input.size(), 64 * kEditBytes);
       i += kEditBytes) {
    const std::size_t place =
        std::to_integer<std::size_t>(input[i + 1]) * 256 + std::to_integer<std::size_t>(input[i + 2]);
    switch (std::to_integer<unsigned>(input[i]) % 4) {
      case 0:
      case 1:
        editPayloads(nodes, place, input[i + 3]);
        break;
      case 2:
        editPayloads(terrain, place, input[i + 3]);
        break;
      default:
        area_edits.emplace_back(place, input[i + 3]);
    }
  }
  sealAll(nodes);
  sealAll(terrain);
  editor.saveArea(true);
  if (!area_edits.empty()) {
    std::string text = files.text(editor.areaPath());
    for (const auto& [place, value] : area_edits) text[place % text.size()] = static_cast<char>(value);
    if (text.find(",\n  \"hash\": \"") != std::string::npos) text = sealAreaText(text);
    files.setText(editor.areaPath(), text);
  }

  CheckOptions options;
  options.threads = 1;
  const Report report = checkDatabase(files, kMemoryDatabasePath, options);
  promise(!report.fatal || report.fatal->kind != ErrorKind::kInternal,
          "a damaged database makes no rule fail");
  const bool clean = report.complete && report.count(Severity::kError) == 0;
  const auto database = Database::open(files, kMemoryDatabasePath);
  promise(database.ok() || !clean, "what the check calls valid can be opened");
  if (!database.ok()) return;
  for (std::uint32_t number = 1; number <= database.value().area().node_count; ++number) {
    const auto record = database.value().record(number);
    promise(record.ok() || !clean, "what the check calls valid has all its records");
    if (!record.ok() || record.value().grid >= database.value().gridCount()) continue;
    Node node;
    node.number = number;
    node.record = record.value();
    promise(database.value().children(node).ok() || !clean, "what the check calls valid can be walked");
    if (node.record.type != NodeType::kTerrain) continue;
    if (node.record.level >= database.value().grid(node.record.grid).header().level_count) continue;
    promise(database.value().terrain(node).ok() || !clean, "what the check calls valid can be read");
  }
  if (!clean) return;
  for (int level = 0; level < database.value().grid(0).header().level_count; ++level) {
    promise(readGrid(database.value(), 0, level).ok(), "what the check calls valid can be exported");
  }
}

std::vector<FuzzInput> databaseSeeds() {
  FuzzInput edits;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) edits.push_back(static_cast<std::byte>(37 * i + 11 * k));
  }
  return {{}, edits, FuzzInput(edits.begin(), edits.begin() + 4)};
}

}  // namespace

std::span<const FuzzTarget> fuzzTargets() {
  static const std::array kTargets = {
      FuzzTarget{"container", fuzzContainer, containerSeeds},
      FuzzTarget{"area", fuzzArea, areaSeeds},
      FuzzTarget{"node_page", fuzzNodePage, nodePageSeeds},
      FuzzTarget{"terrain_block", fuzzTerrainBlock, terrainBlockSeeds},
      FuzzTarget{"codec", fuzzCodec, codecSeeds},
      FuzzTarget{"database", fuzzDatabase, databaseSeeds},
  };
  return kTargets;
}

}  // namespace deltaz

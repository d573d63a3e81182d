#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "formats/area.h"
#include "formats/color_file.h"
#include "formats/container.h"
#include "formats/delta_codec.h"
#include "formats/hash.h"
#include "formats/model_file.h"
#include "formats/node_file.h"
#include "formats/placement_file.h"
#include "formats/terrain_segment.h"
#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "librender/ars/words/triangle_stream.h"
#include "tests/support/asset_editor.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/furnished_area.h"
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
  return index <= footerOffset(file) &&
         blocks * kIndexEntryBytes + pages * kIndexPageFrameBytes <= footerOffset(file) - index;
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
  constexpr std::uint32_t kFirst = 1;
  const auto records = decodeNodePage(input, kFirst, "page");
  if (!records.ok()) return;
  const auto bytes = encodeNodePage(records.value(), kFirst);
  promise(std::equal(bytes.begin(), bytes.end(), input.begin(), input.end()), "a page has one form");
}

std::vector<FuzzInput> nodePageSeeds() {
  const FileBytes& nodes = soundDatabase().bytes(soundEditor().nodePath());
  std::vector<FuzzInput> seeds;
  for (std::uint32_t page = 0; page < blockCount(nodes); ++page) seeds.push_back(payloadOf(nodes, page));
  return seeds;
}

void fuzzPlainNodePage(std::span<const std::byte> input) {
  const auto records = decodePlainNodePage(input, "page");
  promise(!records.ok() || records.value().size() * kPlainNodeRecordBytes == input.size(),
          "every record is read");
}

std::vector<FuzzInput> plainNodePageSeeds() {
  FuzzInput record(kPlainNodeRecordBytes);
  std::fill_n(record.begin() + 28, 4, std::byte{0xFF});  // a cluster has no block
  FuzzInput page = record;
  page.insert(page.end(), record.begin(), record.end());
  return {record, page};
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

// ---- colour maps, models, placements: the first byte says which block it is

constexpr std::uint32_t kBlocks = 4;

// A decoder that refuses, or reads what has one form.
template <typename Decoded, typename Encode>
void expectOneForm(const Decoded& decoded, std::span<const std::byte> input, Encode encode) {
  if (!decoded.ok()) return;
  const std::vector<std::byte> bytes = encode(decoded.value());
  promise(bytes.size() == input.size() && std::equal(bytes.begin(), bytes.end(), input.begin()),
          "what is read has one form");
}

void fuzzColorFile(std::span<const std::byte> input) {
  if (input.empty()) return;
  const auto rest = input.subspan(1);
  switch (std::to_integer<unsigned>(input[0]) % 3) {
    case 0:
      return expectOneForm(decodeColorDirectory(rest, kBlocks, "directory"), rest, encodeColorDirectory);
    case 1:
      return expectOneForm(decodeColorPage(rest, "page"), rest,
                           [](const std::vector<ColorNode>& nodes) { return encodeColorPage(nodes); });
    default:
      const auto texels = decodeColorTile(rest, "tile");
      if (!texels.ok()) return;
      promise(texels.value().size() == kColorTileBytes, "a tile has all its texels");
      const auto again = decodeColorTile(encodeColorTile(texels.value()), "tile");
      promise(again.ok() && again.value() == texels.value(), "texels survive");
  }
}

std::vector<FuzzInput> colorFileSeeds() {
  ColorDirectory directory;
  directory.node_count = directory.first_page = 2;
  directory.trees = {{0, 1, 1, 3, -2}, {5, 2, 1, 4, 4}};
  const std::vector<ColorNode> nodes = {{0, 3, 15, -1, 2, 2, 0}, {5, 4, 0, 0, 0, 0, 1}};
  std::vector<std::uint8_t> texels(kColorTileBytes);
  for (std::size_t k = 0; k < texels.size(); ++k)
    texels[k] = static_cast<std::uint8_t>(k % 4 == 3 ? 255 - k / 400 % 2 : k / 9 % 256);
  return {inputOf(0, encodeColorDirectory(directory)), inputOf(1, encodeColorPage(nodes)),
          inputOf(2, encodeColorTile(texels))};
}

void fuzzModelFile(std::span<const std::byte> input) {
  if (input.empty()) return;
  const auto rest = input.subspan(1);
  if (std::to_integer<unsigned>(input[0]) % 2 == 0)
    return expectOneForm(decodeModelTree(rest, kBlocks, "tree"), rest, encodeModelTree);
  const auto mesh = decodeModelMesh(rest, "mesh");
  expectOneForm(mesh, rest, encodeModelMesh);
  if (!mesh.ok()) return;
  for (const auto& triangle : mesh.value().triangles) {
    for (const std::uint32_t index : triangle)
      promise(index < mesh.value().vertices.size(), "triangles name vertices");
  }
}

std::vector<FuzzInput> modelFileSeeds() {
  ModelTree tree;
  tree.radius = 5;
  tree.parts.resize(2);
  tree.parts[0].name = "body";
  tree.parts[0].lods = {{0, 12, 0}, {1, 4, 0.5f}};
  tree.parts[1].name = "rotor";
  tree.parts[1].parent = 0;
  tree.parts[1].lods = {{2, 1, 0}};
  ModelMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.colors = {{1, 2, 3}, {4, 5, 6}};
  ModelMesh shaded = mesh;
  shaded.colored_by_vertex = shaded.two_sided = true;
  shaded.normals.assign(4, {0, 0, 32767});
  shaded.colors.resize(4);
  return {inputOf(0, encodeModelTree(tree)), inputOf(1, encodeModelMesh(mesh)),
          inputOf(1, encodeModelMesh(shaded))};
}

void fuzzPlacementFile(std::span<const std::byte> input) {
  if (input.empty()) return;
  const auto rest = input.subspan(1);
  if (std::to_integer<unsigned>(input[0]) % 2 == 0)
    return expectOneForm(decodePlacementDirectory(rest, kBlocks, "directory"), rest,
                         encodePlacementDirectory);
  expectOneForm(decodePlacementPage(rest, 2, "page"), rest,
                [](const std::vector<Placement>& placements) { return encodePlacementPage(placements); });
}

std::vector<FuzzInput> placementFileSeeds() {
  PlacementDirectory directory;
  directory.count = 2 * kPlacementsPerPage + 1;
  directory.next_instance = 200;
  directory.pages = {{{1e6, -2e6, 3e6}, 10}, {{1e6, -2e6, 3e6}, 20}, {{0, 0, 6e6}, 0}};
  const std::vector<Placement> placements = {{1, 0, 46.5, -121.5, 1000, 90, false, 0},
                                             {199, 1, -46.5, 21.5, 1000, 0, true, 1.5}};
  return {inputOf(0, encodePlacementDirectory(directory)), inputOf(1, encodePlacementPage(placements))};
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

// The same edits to what colours or stands on the terrain.
void fuzzFurnished(std::span<const std::byte> input) {
  MemoryFileSystem files = furnishedArea();
  static constexpr std::array kRoles = {FileRole::kColors, FileRole::kModel, FileRole::kPlacements};
  for (std::size_t i = 0; i + kEditBytes <= std::min<std::size_t>(input.size(), 64 * kEditBytes);
       i += kEditBytes) {
    const std::size_t place =
        std::to_integer<std::size_t>(input[i + 1]) * 256 + std::to_integer<std::size_t>(input[i + 2]);
    const FileRole role = kRoles[std::to_integer<std::size_t>(input[i]) % kRoles.size()];
    editPayloads(files.mutableBytes(assetPath(files, role)), place, input[i + 3]);
  }
  AreaHeader area = areaOf(files);
  for (FileReference& file : area.files) {
    FileBytes& bytes = files.mutableBytes(kMemoryDatabasePath + "/" + file.name);
    sealAll(bytes);
    file.id = identityOf(bytes).id;
  }
  setArea(files, area);

  CheckOptions options;
  options.threads = 1;
  options.level = CheckLevel::kGeometry;
  const Report report = checkDatabase(files, kMemoryDatabasePath, options);
  promise(!report.fatal, "damaged colours and models make no rule fail");
  const bool clean = report.complete && report.count(Severity::kError) == 0;
  const auto database = Database::open(files, kMemoryDatabasePath);
  promise(database.ok() || !clean, "what the check calls valid can be opened");
  if (!database.ok()) return;
  for (const ColorMap& map : database.value().colorMaps()) {
    for (std::uint32_t number = 1; number <= map.directory().node_count; ++number) {
      const auto node = map.record(number);
      promise((node.ok() && map.tile(node.value()).ok()) || !clean,
              "what the check calls valid has its tiles");
    }
    for (const int level : {-40, 3, 60}) {
      const GridHeader& grid = database.value().area().grids[0];
      promise(map.nodeAt(0, static_cast<double>(grid.x_axis.first + 3),
                         static_cast<double>(grid.y_axis.first + 3), level)
                      .ok() ||
                  !clean,
              "what the check calls valid can be walked");
    }
  }
  for (const Model& model : database.value().models()) {
    for (const ModelPart& part : model.tree().parts) {
      for (const ModelLod& lod : part.lods)
        promise(model.mesh(lod).ok() || !clean, "what the check calls valid has its meshes");
    }
  }
  if (const PlacementSet* placements = database.value().placements(); placements != nullptr)
    promise(placements->all().ok() || !clean, "what the check calls valid has its placements");
}

std::vector<FuzzInput> databaseSeeds() {
  FuzzInput edits;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) edits.push_back(static_cast<std::byte>(37 * i + 11 * k));
  }
  return {{}, edits, FuzzInput(edits.begin(), edits.begin() + 4)};
}

// ---- triangle_stream: an odd first byte asks for right checksums

constexpr std::size_t kStreamHeaderBytes = 64, kStreamChecksumBytes = 8;

void putHash(FuzzInput& bytes, std::size_t at, std::uint64_t hash) {
  for (std::size_t k = 0; k < kStreamChecksumBytes; ++k)
    bytes[at + k] = static_cast<std::byte>(hash >> (8 * k) & 0xFF);
}

void fuzzTriangleStream(std::span<const std::byte> input) {
  if (input.empty()) return;
  FuzzInput bytes(input.begin() + 1, input.end());
  if ((std::to_integer<unsigned>(input[0]) & 1) != 0 &&
      bytes.size() >= kStreamHeaderBytes + kStreamChecksumBytes) {
    const std::span<const std::byte> all = bytes;
    putHash(bytes, kStreamHeaderBytes - kStreamChecksumBytes,
            hash64(all.first(kStreamHeaderBytes - kStreamChecksumBytes)));
    const std::size_t end = bytes.size() - kStreamChecksumBytes;
    putHash(bytes, end, hash64(all.subspan(kStreamHeaderBytes, end - kStreamHeaderBytes)));
  }
  const auto stream = ars::decodeTriangleStream(bytes, "stream");
  if (!stream.ok()) return;
  const auto again = ars::encodeTriangleStream(stream.value());
  promise(again.ok() && again.value() == bytes, "what was read is written back");
  const ars::TilerConfiguration configuration{.numbers = stream.value().profile, .corrections = {}};
  for (const ars::TriangleBatch& batch : stream.value().batches) {
    std::vector<ars::PixelPacket> pixels;
    const ars::TilingCounts counts = ars::tileTriangles(batch.triangles, configuration, pixels);
    promise(counts.tiled == static_cast<std::int64_t>(pixels.size()) && counts.sampled >= counts.tiled,
            "what is tiled was sampled");
    for (const ars::PixelPacket& pixel : pixels)
      promise(pixel.i < ars::kScreenLines && pixel.j < ars::kScreenPixels, "tiled pixels lie in the picture");
    for (const ars::ProjectedTriangle& source : batch.sources) {
      const ars::EncodedTriangle encoded = ars::encodeTriangle(source, configuration.numbers, {});
      promise(ars::isTileable(encoded.variables, configuration.numbers.vertex_fraction_bits),
              "any projected triangle can be encoded");
    }
  }
}

std::vector<FuzzInput> triangleStreamSeeds() {
  std::vector<FuzzInput> seeds;
  for (const bool sources : {false, true}) {
    ars::TriangleStream stream;
    stream.has_sources = sources;
    ars::RandomNumbers random(1);
    for (const ars::DrawPhase phase : {ars::DrawPhase::kBackground, ars::DrawPhase::kForeground}) {
      ars::TriangleBatch batch;
      batch.phase = phase;
      for (int n = 0; n < 3; ++n) {
        const ars::ProjectedTriangle triangle = ars::randomTriangle(random, {.side = 20});
        const ars::EncodedTriangle encoded =
            ars::encodeTriangle(triangle, stream.profile, {.oversample = n == 0, .background = n == 1});
        batch.triangles.push_back(ars::encodeTriangleWords(encoded.variables, stream.profile));
        if (sources) batch.sources.push_back(triangle);
      }
      stream.batches.push_back(batch);
    }
    const std::vector<std::byte> bytes = ars::encodeTriangleStream(stream).value();
    for (const std::uint8_t first : {std::uint8_t{0}, std::uint8_t{1}})
      seeds.push_back(inputOf(first, bytes));
  }
  return seeds;
}

}  // namespace

std::span<const FuzzTarget> fuzzTargets() {
  static const std::array kTargets = {
      FuzzTarget{"container", fuzzContainer, containerSeeds},
      FuzzTarget{"area", fuzzArea, areaSeeds},
      FuzzTarget{"node_page", fuzzNodePage, nodePageSeeds},
      FuzzTarget{"plain_node_page", fuzzPlainNodePage, plainNodePageSeeds},
      FuzzTarget{"terrain_block", fuzzTerrainBlock, terrainBlockSeeds},
      FuzzTarget{"codec", fuzzCodec, codecSeeds},
      FuzzTarget{"color_file", fuzzColorFile, colorFileSeeds},
      FuzzTarget{"model_file", fuzzModelFile, modelFileSeeds},
      FuzzTarget{"placement_file", fuzzPlacementFile, placementFileSeeds},
      FuzzTarget{"database", fuzzDatabase, databaseSeeds},
      FuzzTarget{"furnished", fuzzFurnished, databaseSeeds, 15},
      FuzzTarget{"triangle_stream", fuzzTriangleStream, triangleStreamSeeds},
  };
  return kTargets;
}

}  // namespace deltaz

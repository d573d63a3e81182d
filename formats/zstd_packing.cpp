#include "formats/zstd_packing.h"

#include <cassert>
#include <memory>
#include <zstd.h>

namespace deltaz {

namespace {

// Level 9 packs real terrain 4 % smaller than the default and still encodes faster than sources are read.
constexpr int kZstdLevel = 9;

struct FreeCompressor {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

std::vector<std::byte> packBytes(std::span<const std::byte> raw) {
  const std::unique_ptr<ZSTD_CCtx, FreeCompressor> context(ZSTD_createCCtx());
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kZstdLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_contentSizeFlag, 1);
  std::vector<std::byte> packed(ZSTD_compressBound(raw.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), raw.data(), raw.size());
  assert(!ZSTD_isError(size));
  packed.resize(size);
  return packed;
}

bool unpackBytes(std::span<const std::byte> packed, std::span<std::byte> raw) {
  // One frame that says how much it holds: a decompressor would also take several, or empty ones behind it.
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != raw.size() ||
      ZSTD_findFrameCompressedSize(packed.data(), packed.size()) != packed.size())
    return false;
  const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  return !ZSTD_isError(size) && size == raw.size();
}

}  // namespace deltaz

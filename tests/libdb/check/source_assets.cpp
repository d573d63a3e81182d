// Databases against sources that are not theirs.
#include "tests/libdb/check/code_assets.h"

namespace deltaz {

namespace {

Recipe against(const std::function<void(RawGrid&)>& change) {
  return [change](const MemoryFileSystem& files) {
    RawGrid source = sourceGrid();
    change(source);
    return checkedAt(files, CheckLevel::kDecode, &source);
  };
}

}  // namespace

std::vector<Asset> sourceAssets() {
  return {
      {IssueCode::kSrcHeight, against([](RawGrid& source) { source.heights.at(500) += 1; }),
       against([](RawGrid& source) {
         // The void post: its height means nothing.
         for (std::size_t i = 0; i < source.valid.size(); ++i)
           source.heights[i] += source.valid[i] == 0 ? 77 : 0;
       })},
      {IssueCode::kSrcVoid, against([](RawGrid& source) { source.valid.at(500) = 0; }),
       against([](RawGrid&) {})},
      {IssueCode::kSrcExtent, against([](RawGrid& source) {
         source.header.y_axis.count -= 1;
         const auto size = static_cast<std::size_t>(source.header.y_axis.count * source.header.x_axis.count);
         source.heights.resize(size);
         source.valid.resize(size);
       }),
       against([](RawGrid& source) { source.header.sources[0].name = "another name.tif"; })},
      {IssueCode::kSrcGeoreference, against([](RawGrid& source) { source.header.x_axis.phase = 0.5; }),
       // A geotransform that went through text.
       against([](RawGrid& source) {
         source.header.x_axis.exact_spacing.reset();
         source.header.x_axis.spacing *= 1 + 1e-13;
       })},
  };
}

}  // namespace deltaz

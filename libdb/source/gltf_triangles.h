// How many triangles a glTF announces. Assimp leaves out those whose indices are wrong and says nothing, so
// that a difference is the only trace. Thread-safety: pure function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltaz {

// Of the meshes of the scene shown by default, each counted once however often it is used. `bytes` are those
// of a glTF 2 or GLB; 0 if they cannot be understood, which its reader will say.
std::uint64_t announcedTriangles(const std::vector<std::byte>& bytes);

}  // namespace deltaz

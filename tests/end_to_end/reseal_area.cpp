// reseal_area FILE OLD NEW: replaces OLD by NEW in an area.json and writes its hash anew, so that tests can
// make databases that are wrong in meaning only.
#include <fstream>
#include <iostream>
#include <span>
#include <sstream>
#include <string>

#include "formats/hash.h"

int main(int argc, char** argv) {
  constexpr std::string_view kHashMember = ",\n  \"hash\": \"";
  if (argc != 4) return 2;
  const std::string path = argv[1], from = argv[2], to = argv[3];
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  std::string text = content.str();
  const std::size_t at = text.find(from), hash_at = text.rfind(kHashMember);
  if (at == std::string::npos || hash_at == std::string::npos) {
    std::cerr << "reseal_area: '" << from << "' or the hash is not in " << path << '\n';
    return 1;
  }
  text.resize(hash_at);
  text.replace(at, from.size(), to);
  const std::string hash = deltaz::toHex(deltaz::hash128(std::as_bytes(std::span<const char>(text))));
  text += std::string(kHashMember) + hash + "\"\n}\n";
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  return 0;
}

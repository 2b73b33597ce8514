#include "cli/sha256.h"

#include <nettle/base16.h>

#include <array>
#include <fstream>

#include "errors.h"

namespace hemirad {

void Sha256::add(const void* bytes, std::size_t count) {
    sha256_update(&context_, count, static_cast<const std::uint8_t*>(bytes));
}

std::string Sha256::digits() {
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
    sha256_digest(&context_, digest.size(), digest.data());
    std::string text(BASE16_ENCODE_LENGTH(digest.size()), '0');
    base16_encode_update(text.data(), digest.size(), digest.data());
    return text;
}

std::string sha256(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw OutputError(path.string() + ": cannot be read back");
    Sha256 sum;
    std::array<char, 1 << 16> block;
    while (file.read(block.data(), block.size()) || file.gcount() > 0)
        sum.add(block.data(), static_cast<std::size_t>(file.gcount()));
    if (file.bad()) throw OutputError(path.string() + ": cannot be read back");
    return sum.digits();
}

}  // namespace hemirad

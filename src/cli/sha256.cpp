#include "cli/sha256.h"

#include <nettle/base16.h>
#include <nettle/sha2.h>

#include <array>
#include <fstream>

#include "errors.h"

namespace hemirad {

std::string sha256(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw OutputError(path.string() + ": cannot be read back");
    sha256_ctx context;
    sha256_init(&context);
    std::array<char, 1 << 16> block;
    while (file.read(block.data(), block.size()) || file.gcount() > 0)
        sha256_update(&context, static_cast<std::size_t>(file.gcount()),
                      reinterpret_cast<const std::uint8_t*>(block.data()));
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
    sha256_digest(&context, digest.size(), digest.data());
    std::string text(BASE16_ENCODE_LENGTH(digest.size()), '0');
    base16_encode_update(text.data(), digest.size(), digest.data());
    return text;
}

}  // namespace hemirad

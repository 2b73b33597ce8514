#pragma once

#include <nettle/sha2.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace hemirad {

/// Of bytes that come in pieces.
class Sha256 {
  public:
    Sha256() { sha256_init(&context_); }

    void add(const void* bytes, std::size_t count);
    void add(std::string_view text) { add(text.data(), text.size()); }

    /// 64 hexadecimal digits; begins anew.
    std::string digits();

  private:
    sha256_ctx context_;
};

/// Of a file's bytes. Throws OutputError where it cannot be read: it is asked of what was just
/// written.
std::string sha256(const std::filesystem::path& path);

}  // namespace hemirad

#pragma once

#include <cstddef>

#include "mp1map/opencl.h"

namespace mp1map {

/// A plural variable (MPL's word): one or several T in the memory of every PE, element
/// layer * pe_count + pe. Made by Acu::plural.
template <class T>
class Plural {
  public:
    Plural() = default;
    Plural(cl::Buffer buffer, std::size_t size) : buffer_(std::move(buffer)), size_(size) {}

    std::size_t size() const { return size_; }  ///< elements
    const cl::Buffer& buffer() const { return buffer_; }

  private:
    cl::Buffer buffer_;
    std::size_t size_ = 0;
};

}  // namespace mp1map

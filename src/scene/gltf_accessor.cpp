#include <algorithm>
#include <cstring>
#include <limits>

#include "scene/gltf_file.h"

namespace hemirad {
namespace {

// Of an accessor that is all zeros but for a few sparse values nothing in the file bounds the size.
constexpr std::size_t kLargestZeroFilled = std::size_t{1} << 24;

struct Accessor {
    const GltfFile& gltf;
    const tinygltf::Accessor& source;
    std::string path;
    std::size_t components;

    [[noreturn]] void fail(const std::string& reason) const {
        hemirad::fail(gltf.file, path, reason);
    }
};

/// A run of equally spaced elements, checked to lie inside its bufferView.
struct Elements {
    std::string_view bytes;
    std::size_t stride;
    int component_type;
};

std::size_t component_size(const Accessor& accessor, int component_type) {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type));
    const bool known = component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                       component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT ||
                       (size == 1 || size == 2);
    if (!known) accessor.fail("component type " + std::to_string(component_type));
    return static_cast<std::size_t>(size);
}

struct Run {
    int view;
    std::size_t offset, count, components;
    int component_type;
};

Elements locate(const Accessor& accessor, const Run& run) {
    const auto& model = accessor.gltf.model;
    const std::size_t size = run.components * component_size(accessor, run.component_type);
    const std::size_t declared = model.bufferViews[static_cast<std::size_t>(run.view)].byteStride;
    const std::size_t stride = declared > 0 ? declared : size;
    const std::string_view bytes = view_bytes(model, run.view);
    // No overflow: check_gltf keeps every factor below 2^31.
    const std::size_t end = run.offset + (run.count - 1) * stride + size;
    if (stride < size) accessor.fail("elements overlap: a byteStride of " + std::to_string(stride));
    if (end > bytes.size()) {
        accessor.fail("ends at byte " + std::to_string(end) + " of bufferView " +
                      std::to_string(run.view) + ", which holds " + std::to_string(bytes.size()));
    }
    return {bytes.substr(run.offset), stride, run.component_type};
}

template <class Component>
double component_at(const char* bytes, bool normalized) {
    Component value;
    std::memcpy(&value, bytes, sizeof value);
    if (!normalized || !std::numeric_limits<Component>::is_integer) return double(value);
    // glTF 2.0, sec. 3.11: the most negative integer is -1 too.
    return std::max(double(value) / double(std::numeric_limits<Component>::max()), -1.0);
}

double component_at(const char* bytes, int component_type, bool normalized) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return component_at<std::int8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return component_at<std::uint8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return component_at<std::int16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return component_at<std::uint16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return component_at<std::uint32_t>(bytes, normalized);
        default:
            return component_at<float>(bytes, normalized);
    }
}

void copy_element(const Accessor& accessor, const Elements& from, std::size_t index, double* to) {
    const std::size_t size = component_size(accessor, from.component_type);
    const char* bytes = from.bytes.data() + index * from.stride;
    for (std::size_t i = 0; i < accessor.components; ++i) {
        to[i] = component_at(bytes + i * size, from.component_type, accessor.source.normalized);
    }
}

void fill_sparse(const Accessor& accessor, std::vector<double>& values) {
    const auto& sparse = accessor.source.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    if (count > accessor.source.count) accessor.fail("has more sparse values than elements");
    const auto offset = [](int bytes) { return static_cast<std::size_t>(bytes); };
    const Elements indices =
        locate(accessor, {sparse.indices.bufferView, offset(sparse.indices.byteOffset), count, 1,
                          sparse.indices.componentType});
    const Elements elements =
        locate(accessor, {sparse.values.bufferView, offset(sparse.values.byteOffset), count,
                          accessor.components, accessor.source.componentType});
    for (std::size_t i = 0; i < count; ++i) {
        const double index =
            component_at(indices.bytes.data() + i * indices.stride, indices.component_type, false);
        if (!(index >= 0 && index < double(accessor.source.count))) {
            accessor.fail("sparse index " + number(index) + " is out of range");
        }
        copy_element(accessor, elements, i,
                     &values[static_cast<std::size_t>(index) * accessor.components]);
    }
}

std::vector<double> dense_values(const Accessor& accessor) {
    const auto& source = accessor.source;
    if (source.bufferView < 0) {
        if (!source.sparse.isSparse) accessor.fail("has no bufferView");
        if (source.count > kLargestZeroFilled) accessor.fail("has no bufferView for its size");
        return std::vector<double>(source.count * accessor.components);
    }
    const Elements elements = locate(accessor, {source.bufferView, source.byteOffset, source.count,
                                                accessor.components, source.componentType});
    std::vector<double> values(source.count * accessor.components);
    for (std::size_t i = 0; i < source.count; ++i) {
        copy_element(accessor, elements, i, &values[i * accessor.components]);
    }
    return values;
}

}  // namespace

std::vector<double> read_accessor(const GltfFile& gltf, int index, int components) {
    const Accessor accessor{gltf, gltf.model.accessors[static_cast<std::size_t>(index)],
                            "accessors/" + std::to_string(index),
                            static_cast<std::size_t>(components)};
    const int found = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.source.type));
    if (found != components) {
        accessor.fail("has " + std::to_string(found) + " components instead of " +
                      std::to_string(components));
    }
    std::vector<double> values = dense_values(accessor);
    if (accessor.source.sparse.isSparse) fill_sparse(accessor, values);
    return values;
}

}  // namespace hemirad

#include "assets/gltf_accessor.h"

#include <cmath>
#include <cstring>

namespace toile::assets {
namespace {

template <typename T>
double component(const std::uint8_t* data) {
    T value;
    std::memcpy(&value, data, sizeof(T));
    return static_cast<double>(value);
}

double component(const std::uint8_t* data, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return component<std::int8_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return component<std::uint8_t>(data);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return component<std::int16_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return component<std::uint16_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return component<std::uint32_t>(data);
    default:
        return static_cast<double>(component<float>(data));
    }
}

std::size_t component_size(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

// glTF 2.0, section 3.11: c / 127, c / 255, ... and no less than -1.
double normalised(double value, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return std::max(value / 127.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return value / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return std::max(value / 32767.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return value / 65535.0;
    default:
        return value;
    }
}

int components_of(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    case TINYGLTF_TYPE_MAT4:
        return 16;
    default:
        return 0; // MAT2 and MAT3 have padded columns and no use here
    }
}

} // namespace

const tinygltf::Accessor& AccessorReader::at(int accessor, const std::string& what) const {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model_.accessors.size())
        throw budget_.error(what + " names accessor " + std::to_string(accessor) +
                            ", which does not exist");
    return model_.accessors[static_cast<std::size_t>(accessor)];
}

std::size_t AccessorReader::count(int accessor, const std::string& what) const {
    return at(accessor, what).count;
}

int AccessorReader::components(int accessor, const std::string& what) const {
    return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(at(accessor, what).type));
}

AccessorReader::Elements AccessorReader::elements(int view, std::size_t offset, std::size_t count,
                                                  int component_type, int components,
                                                  const std::string& what) const {
    if (view < 0 || static_cast<std::size_t>(view) >= model_.bufferViews.size())
        throw budget_.error(what + " names a buffer view that does not exist");
    const tinygltf::BufferView& bv = model_.bufferViews[static_cast<std::size_t>(view)];
    if (bv.buffer < 0 || static_cast<std::size_t>(bv.buffer) >= model_.buffers.size())
        throw budget_.error(what + " names a buffer that does not exist");
    const auto& data = model_.buffers[static_cast<std::size_t>(bv.buffer)].data;
    const std::size_t size = component_size(component_type) * static_cast<std::size_t>(components);
    if (size == 0) throw budget_.error(what + " has an unknown component type");
    const std::size_t stride = bv.byteStride != 0 ? bv.byteStride : size;
    const bool view_fits =
        bv.byteOffset <= data.size() && bv.byteLength <= data.size() - bv.byteOffset;
    const bool fits = view_fits && stride >= size && offset <= bv.byteLength &&
                      size <= bv.byteLength - offset &&
                      (count - 1) <= (bv.byteLength - offset - size) / stride;
    if (!fits)
        throw budget_.error(what + " claims " + std::to_string(count) +
                            " elements, which reach beyond its buffer");
    return {data.data() + bv.byteOffset + offset, stride, component_type};
}

void AccessorReader::apply_sparse(const tinygltf::Accessor& accessor, int components,
                                  const std::string& what, std::vector<double>& values) const {
    const auto& sparse = accessor.sparse;
    if (sparse.count <= 0 || static_cast<std::size_t>(sparse.count) > accessor.count ||
        sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        throw budget_.error(what + " has an impossible sparse part");
    const auto count = static_cast<std::size_t>(sparse.count);
    const Elements where =
        elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                 count, sparse.indices.componentType, 1, what);
    const Elements with =
        elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                 count, accessor.componentType, components, what);
    const auto width = static_cast<std::size_t>(components);
    for (std::size_t i = 0; i < count; ++i) {
        const double index = component(where.data + i * where.stride, where.component_type);
        if (!(index >= 0.0 && index < static_cast<double>(accessor.count)))
            throw budget_.error(what + " has a sparse index out of range");
        for (std::size_t k = 0; k < width; ++k)
            values[static_cast<std::size_t>(index) * width + k] =
                component(with.data + i * with.stride + k * component_size(with.component_type),
                          with.component_type);
    }
}

std::vector<double> AccessorReader::read(int index, int components, const std::string& what) {
    const tinygltf::Accessor& accessor = at(index, what);
    if (components_of(accessor.type) != components)
        throw budget_.error(what + " does not have " + std::to_string(components) +
                            " component(s) per element");
    const auto width = static_cast<std::size_t>(components);
    if (accessor.count == 0) throw budget_.error(what + " is empty");
    Elements source;
    if (accessor.bufferView != -1)
        source = elements(accessor.bufferView, accessor.byteOffset, accessor.count,
                          accessor.componentType, components, what);
    budget_.take(accessor.count, width * sizeof(double), what);
    std::vector<double> values(accessor.count * width, 0.0);
    if (source.data != nullptr) {
        const std::size_t size = component_size(source.component_type);
        for (std::size_t i = 0; i < accessor.count; ++i)
            for (std::size_t k = 0; k < width; ++k)
                values[i * width + k] =
                    component(source.data + i * source.stride + k * size, source.component_type);
    }
    if (accessor.sparse.isSparse) apply_sparse(accessor, components, what, values);
    return values;
}

std::vector<float> AccessorReader::floats(int index, int components, const std::string& what) {
    const std::vector<double> values = read(index, components, what);
    const tinygltf::Accessor& accessor = at(index, what);
    std::vector<float> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double v =
            accessor.normalized ? normalised(values[i], accessor.componentType) : values[i];
        if (!std::isfinite(v))
            throw budget_.error(what + " holds a number that is not finite (element " +
                                std::to_string(i / static_cast<std::size_t>(components)) + ")");
        result[i] = static_cast<float>(v);
    }
    return result;
}

std::vector<std::uint32_t> AccessorReader::integers(int index, int components,
                                                    const std::string& what) {
    const int type = at(index, what).componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        throw budget_.error(what + " must hold unsigned whole numbers");
    const std::vector<double> values = read(index, components, what);
    std::vector<std::uint32_t> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        result[i] = static_cast<std::uint32_t>(values[i]);
    return result;
}

} // namespace toile::assets

#include "assets/gltf_parts.h"
#include "core/log.h"

#include <cmath>

namespace toile::assets {
namespace {

constexpr int kSplinePieces = 8; // linear pieces that stand for one cubic interval

Vec4f element(const std::vector<float>& values, std::size_t index, int width) {
    Vec4f v = Vec4f::Zero();
    for (int k = 0; k < width; ++k)
        v[k] = values[index * static_cast<std::size_t>(width) + static_cast<std::size_t>(k)];
    return v;
}

void add_key(Channel& channel, float time, const Vec4f& value) {
    channel.times.push_back(time);
    const bool rotation = channel.path == Channel::Path::rotation && value.norm() > 0.0f;
    channel.values.push_back(rotation ? Vec4f(value.normalized()) : value);
}

// A step holds the old value until just before the next key.
void fill_step(const std::vector<float>& times, const std::vector<float>& values, int width,
               Channel& channel) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        const float before = std::nextafter(times[i], -1.0f);
        if (i > 0 && before > times[i - 1]) add_key(channel, before, element(values, i - 1, width));
        add_key(channel, times[i], element(values, i, width));
    }
}

// glTF 2.0, appendix C: per key in-tangent, value, out-tangent; cubic Hermite between.
void fill_cubic(const std::vector<float>& times, const std::vector<float>& values, int width,
                Channel& channel) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        add_key(channel, times[i], element(values, 3 * i + 1, width));
        if (i + 1 == times.size()) break;
        const float span = times[i + 1] - times[i];
        const Vec4f a = element(values, 3 * i + 1, width);
        const Vec4f leaving = span * element(values, 3 * i + 2, width);
        const Vec4f arriving = span * element(values, 3 * i + 3, width);
        const Vec4f b = element(values, 3 * i + 4, width);
        for (int piece = 1; piece < kSplinePieces; ++piece) {
            const float t = static_cast<float>(piece) / kSplinePieces;
            const float time = times[i] + t * span;
            if (!(time > channel.times.back() && time < times[i + 1])) continue;
            const float t2 = t * t;
            const float t3 = t2 * t;
            add_key(channel, time,
                    (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * leaving +
                        (3 * t2 - 2 * t3) * b + (t3 - t2) * arriving);
        }
    }
}

Channel read_channel(const tinygltf::AnimationSampler& sampler, Channel::Path path,
                     AccessorReader& accessors, const Budget& budget, const std::string& where) {
    Channel channel;
    channel.path = path;
    const int width = path == Channel::Path::rotation ? 4 : 3;
    const std::vector<float> times = accessors.floats(sampler.input, 1, where + ", times");
    const std::vector<float> values = accessors.floats(sampler.output, width, where + ", values");
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] < 0.0f || (i > 0 && times[i] <= times[i - 1]))
            throw budget.error(where + ": its times do not rise");
    const bool cubic = sampler.interpolation == "CUBICSPLINE";
    if (values.size() != times.size() * static_cast<std::size_t>(width) * (cubic ? 3 : 1))
        throw budget.error(where + " does not have one value per time");
    if (cubic)
        fill_cubic(times, values, width, channel);
    else if (sampler.interpolation == "STEP")
        fill_step(times, values, width, channel);
    else
        for (std::size_t i = 0; i < times.size(); ++i)
            add_key(channel, times[i], element(values, i, width));
    return channel;
}

} // namespace

Animation read_gltf_animation(const tinygltf::Animation& from, const std::vector<int>& node_index,
                              AccessorReader& accessors, const Budget& budget) {
    Animation animation;
    animation.name = from.name;
    const std::string who = "animation '" + from.name + "'";
    bool morphs = false;
    for (std::size_t i = 0; i < from.channels.size(); ++i) {
        const tinygltf::AnimationChannel& channel = from.channels[i];
        const std::string where = who + ", channel " + std::to_string(i);
        const Channel::Path path = channel.target_path == "translation" ? Channel::Path::translation
                                   : channel.target_path == "rotation"  ? Channel::Path::rotation
                                   : channel.target_path == "scale"     ? Channel::Path::scale
                                                                        : Channel::Path::invalid;
        if (path == Channel::Path::invalid || channel.target_node < 0) {
            morphs = true;
            continue;
        }
        if (static_cast<std::size_t>(channel.target_node) >= node_index.size())
            throw budget.error(where + " names a node that does not exist");
        if (channel.sampler < 0 ||
            static_cast<std::size_t>(channel.sampler) >= from.samplers.size())
            throw budget.error(where + " names a sampler that does not exist");
        Channel read = read_channel(from.samplers[static_cast<std::size_t>(channel.sampler)], path,
                                    accessors, budget, where);
        read.node = node_index[static_cast<std::size_t>(channel.target_node)];
        animation.channels.push_back(std::move(read));
    }
    if (morphs)
        log::warning(budget.file() + ": " + who +
                     ": channels that do not move a node (morph weights) are left out");
    return animation;
}

} // namespace toile::assets

#include "apps/picture_comparison.h"

#include "core/error.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::apps {
namespace {

using OIIO::ImageBuf;

ImageBuf load(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) throw FileError(file.string(), "no such file");
    ImageBuf image(file.string());
    if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
        throw FileError(file.string(), "not a picture that can be read: " + image.geterror());
    }
    return image;
}

std::string size_text(const ImageBuf& image) {
    return std::to_string(image.spec().width) + " x " + std::to_string(image.spec().height);
}

void write_difference(const ImageBuf& a, const ImageBuf& b, const std::filesystem::path& file) {
    const ImageBuf strong = OIIO::ImageBufAlgo::mul(OIIO::ImageBufAlgo::absdiff(a, b), 8.0f);
    const ImageBuf colors = OIIO::ImageBufAlgo::channels(strong, 3, {0, 1, 2});
    if (!colors.write(file.string(), OIIO::TypeDesc::UINT8)) {
        throw FileError(file.string(), "cannot be written: " + colors.geterror());
    }
}

void count(const ImageBuf& a, const ImageBuf& b, const PictureTolerance& tolerance,
           PictureComparison& out) {
    const int channels = a.nchannels();
    double sum = 0.0;
    OIIO::ImageBuf::ConstIterator<float> other(b);
    for (OIIO::ImageBuf::ConstIterator<float> pixel(a); !pixel.done(); ++pixel, ++other) {
        double difference = 0.0;
        for (int c = 0; c < channels; ++c) {
            difference = std::max(difference, std::abs(static_cast<double>(pixel[c]) -
                                                       static_cast<double>(other[c])));
        }
        sum += difference;
        // Differences of 8-bit values are multiples of 1/255 up to rounding.
        constexpr double kRounding = 1e-6;
        if (difference > tolerance.small + kRounding) ++out.beyond_small;
        if (difference > tolerance.warn + kRounding) ++out.beyond_warn;
        if (difference > out.worst) {
            out.worst = difference;
            out.worst_x = pixel.x() - a.spec().x;
            out.worst_y = pixel.y() - a.spec().y;
        }
    }
    out.mean = sum / static_cast<double>(out.pixels);
}

} // namespace

PictureComparison compare_pictures(const std::filesystem::path& a, const std::filesystem::path& b,
                                   const PictureTolerance& tolerance,
                                   const std::filesystem::path& difference) {
    const ImageBuf first = load(a);
    const ImageBuf second = load(b);
    PictureComparison out;
    out.same_size =
        first.spec().width == second.spec().width && first.spec().height == second.spec().height;
    if (!out.same_size || first.nchannels() != second.nchannels()) {
        const auto all = [](const ImageBuf& i) {
            return size_text(i) + " pixels of " + std::to_string(i.nchannels()) + " channels";
        };
        out.text = "the sizes differ: " + all(first) + " and " + all(second);
        return out;
    }
    out.pixels = static_cast<std::size_t>(first.spec().image_pixels());
    count(first, second, tolerance, out);
    if (!difference.empty()) write_difference(first, second, difference);
    const double allowed = tolerance.share * static_cast<double>(out.pixels);
    const bool few = static_cast<double>(out.beyond_small) <= allowed;
    const bool mild = out.worst <= tolerance.largest + 1e-6;
    out.equal = few && mild;
    char text[300];
    std::snprintf(text, sizeof(text),
                  "%zu of %zu pixels (%.4f %%) differ by more than %.4f, %.4f %% allowed; worst "
                  "%.4f at (%d, %d), %.4f allowed; mean %.6f",
                  out.beyond_small, out.pixels,
                  100.0 * static_cast<double>(out.beyond_small) / static_cast<double>(out.pixels),
                  tolerance.small, 100.0 * tolerance.share, out.worst, out.worst_x, out.worst_y,
                  tolerance.largest, out.mean);
    out.text = text;
    return out;
}

} // namespace toile::apps

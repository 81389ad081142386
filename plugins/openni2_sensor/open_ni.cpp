#include "openni2_sensor/open_ni.h"

#include "core/error.h"

#include <OpenNI.h>
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>

namespace toile::openni2_sensor {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& text) {
    return !text.empty() && text.size() < 4 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void check_recording(const fs::path& file) {
    if (!fs::is_regular_file(file)) throw FileError(file.string(), "there is no such recording");
    std::array<char, 4> magic{};
    std::ifstream(file, std::ios::binary).read(magic.data(), magic.size());
    if (std::string(magic.data(), magic.size()) != "NI10")
        throw FileError(file.string(), "is no OpenNI recording (does not begin with NI10)");
}

/// Paths that recordings are open by, in the whole process.
class Leases {
  public:
    static Leases& instance() {
        static auto* const leases = new Leases; // addresses may outlive everything static
        return *leases;
    }
    /// The file by a path that nobody has: dots are put in as long as somebody does.
    Address take(const fs::path& file) {
        const std::scoped_lock lock(mutex_);
        fs::path path = file;
        while (!taken_.insert(path.string()).second)
            path = path.parent_path() / "." / path.filename();
        const std::string name = path.string();
        return {name, true, std::shared_ptr<const void>(this, [this, name](const void*) {
                    const std::scoped_lock release(mutex_);
                    taken_.erase(name);
                })};
    }

  private:
    std::mutex mutex_;
    std::set<std::string> taken_;
};

std::string what_there_is(const std::vector<DeviceName>& devices) {
    if (devices.empty())
        return "OpenNI2 sees no camera: connect one; its driver must stand in OpenNI2/Drivers "
               "beside "
               "libOpenNI2 (Kinects need one of their own), and udev must let this user read the "
               "USB device";
    std::string out = "there are:";
    for (std::size_t i = 0; i < devices.size(); ++i)
        out += " [" + std::to_string(i) + "] " + devices[i].vendor + " " + devices[i].name + " (" +
               devices[i].uri + ")";
    return out;
}

} // namespace

const OpenNiLibrary& OpenNiLibrary::running() {
    static const OpenNiLibrary* const library = new OpenNiLibrary();
    return *library;
}

OpenNiLibrary::OpenNiLibrary() {
    if (openni::OpenNI::initialize() != openni::STATUS_OK)
        throw Error(std::string("OpenNI2 does not start: ") + openni::OpenNI::getExtendedError());
}

std::vector<DeviceName> list_devices(const OpenNiLibrary&) {
    openni::Array<openni::DeviceInfo> found;
    openni::OpenNI::enumerateDevices(&found);
    std::vector<DeviceName> out;
    for (int i = 0; i < found.getSize(); ++i) {
        std::error_code ignored;
        if (fs::is_regular_file(found[i].getUri(), ignored)) continue; // an opened recording
        out.push_back({found[i].getUri(), found[i].getVendor(), found[i].getName()});
    }
    return out;
}

Address resolve(const std::string& source, const OpenNiLibrary& library) {
    const bool names_file = fs::path(source).extension() == ".oni" || fs::is_regular_file(source);
    if (names_file) {
        check_recording(source);
        return Leases::instance().take(source);
    }
    const auto devices = list_devices(library);
    const std::size_t index = source.empty()      ? 0
                              : is_number(source) ? std::stoul(source)
                                                  : devices.size();
    if (source.empty() || is_number(source)) {
        if (index < devices.size()) return {devices[index].uri, false, nullptr};
        throw Error("openni2:" + source + ": no such camera; " + what_there_is(devices));
    }
    const bool known = std::any_of(devices.begin(), devices.end(),
                                   [&](const DeviceName& d) { return d.uri == source; });
    if (!known) throw Error("openni2:" + source + ": no such camera; " + what_there_is(devices));
    return {source, false, nullptr};
}

} // namespace toile::openni2_sensor

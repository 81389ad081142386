// OpenNI2 as a whole: started, and asked which cameras there are.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace toile::openni2_sensor {

/// OpenNI2, running. One for the process and until its end: shutting it down unloads drivers whose
/// threads may still run, and then it crashes.
///
/// It also remembers every thread that ever called it, and may crash when a new one calls after one
/// of those has ended. So what is not done frame by frame is done on one thread that never ends.
class OpenNiLibrary {
  public:
    /// Started at the first call. \throw Error when it cannot start [any thread]
    [[nodiscard]] static const OpenNiLibrary& running();
    OpenNiLibrary(const OpenNiLibrary&) = delete;
    OpenNiLibrary& operator=(const OpenNiLibrary&) = delete;

    /// Has work done on that thread, after what was posted before. Exceptions come with the result.
    template <class Work>
    std::future<std::invoke_result_t<Work>> post(Work work) const {
        auto task =
            std::make_shared<std::packaged_task<std::invoke_result_t<Work>()>>(std::move(work));
        auto result = task->get_future();
        enqueue([task] { (*task)(); });
        return result;
    }

  private:
    OpenNiLibrary();
    void enqueue(std::function<void()> work) const;
    struct Queue;
    std::shared_ptr<Queue> queue_;
};

struct DeviceName {
    std::string uri, vendor, name;
};

/// Cameras that OpenNI2's drivers see now, in their order; no recordings. [the library's thread]
[[nodiscard]] std::vector<DeviceName> list_devices(const OpenNiLibrary& library);

/// What a source URI means, without its scheme: the first device (""), one by its number ("1"), a
/// recording ("FILE.oni"), or OpenNI2's own URI of a device.
struct Address {
    std::string uri; ///< as OpenNI2 wants it
    bool recording = false;
    /// A recording's: no other address has this URI while a copy of this one lives. Two players of
    /// one URI would share one device, and each would get some of its frames.
    std::shared_ptr<const void> lease;
};
/// \throw Error: no such device (names those that there are, or what may be missing), no such file,
/// or a file that is no recording [the library's thread]
[[nodiscard]] Address resolve(const std::string& source, const OpenNiLibrary& library);

} // namespace toile::openni2_sensor

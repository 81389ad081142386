// A scanner of one camera as the plugin boundary sees it, over a session class with
//     void add(std::span<const float> depth_m, std::span<const Byte4> color);
//     void guide(std::uint32_t instant, TriangleMesh body, std::span<const std::uint8_t> labels);
//     Result finish(const std::function<void(double)>& progress);  // mesh, colors, report
// whose Errors become failures with their text.
#pragma once

#include "boundary/scan_output.h"
#include "boundary/stream_camera.h"
#include "core/error.h"
#include "core/row_loop.h"
#include "sdk/job.h"
#include "sdk/scan_guide.h"
#include "sdk/structs.h"
#include "sdk/thread_pool.h"

#include <memory>
#include <string>

namespace toile::boundary {

template <class Session>
class OneCameraScan {
  public:
    OneCameraScan(sdk::Host host, std::string method, std::uint32_t most_frames)
        : pool_(host), method_(std::move(method)), most_frames_(most_frames) {}

    /// `make(camera, rows)` gives the session's unique_ptr.
    template <class Make>
    void begin(const sdk::SizedArray<const toile_stream>& streams, const Make& make) {
        session_.reset();
        if (streams.size() > 1)
            throw sdk::Failure(TOILE_E_UNSUPPORTED, method_ + " takes one camera; " +
                                                        std::to_string(streams.size()) +
                                                        " were named");
        try {
            session_ = make(camera_of(streams[0]), rows());
        } catch (const Error& e) {
            throw sdk::bad_argument(e.what());
        }
        camera_ = streams[0].camera;
        pixels_ = std::size_t{streams[0].depth.width} * streams[0].depth.height;
        fed_ = 0;
    }

    void feed(const sdk::SizedArray<const toile_frame>& frames) {
        if (!session_) throw sdk::bad_argument("feed: called before begin");
        for (std::uint32_t i = 0; i < frames.size(); ++i)
            feed(frames[i]);
    }

    void guide(const toile_scan_template& rough) {
        if (!session_) throw sdk::bad_argument("guide: called before begin");
        const auto positions =
            sdk::span_of<sdk::Float3>(rough.surface.positions, "template.surface.positions");
        const auto triangles =
            sdk::span_of<sdk::Triangle>(rough.surface.triangles, "template.surface.triangles");
        const auto labels = sdk::span_of<std::uint8_t>(rough.part_labels, "template.part_labels");
        geometry::TriangleMesh body;
        for (const sdk::Float3& p : positions)
            body.positions.emplace_back(p[0], p[1], p[2]);
        body.triangles.assign(triangles.begin(), triangles.end());
        if (triangles.empty() || !geometry::check_topology(body.positions, body.triangles).usable())
            throw sdk::bad_argument(
                "template.surface: empty, not finite, or an index out of range");
        try {
            session_->guide(rough.instant, std::move(body), labels);
        } catch (const Error& e) {
            throw sdk::bad_argument(e.what());
        }
    }

    void finish(toile_scan_sink& sink, sdk::Job job) {
        if (!session_) throw sdk::bad_argument("finish: called before begin");
        const auto session = std::move(session_); // once
        try {
            const auto result =
                session->finish([&](double share) { job.progress(share, "registering"); });
            give(result.mesh, result.colors, result.report.dump(), sink);
        } catch (const Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
        job.progress(1.0);
    }

  private:
    void feed(const toile_frame& frame) {
        if (frame.camera != camera_)
            throw sdk::bad_argument("frames: a camera that was not announced");
        if (fed_++ >= most_frames_)
            throw sdk::Failure(TOILE_E_CAPACITY, "more than " + std::to_string(most_frames_) +
                                                     " frames: take fewer a second");
        const auto depth = sdk::span_of<float>(frame.depth_m, "frame.depth_m", pixels_);
        const auto color = sdk::span_of<sdk::Byte4>(frame.color, "frame.color");
        if (!color.empty() && color.size() != pixels_)
            throw sdk::bad_argument("frame.color: not of the depth picture's size");
        try {
            session_->add(depth, color);
        } catch (const Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
    }

    [[nodiscard]] RowLoop rows() const {
        return [this](std::uint32_t count, std::uint32_t grain, const auto& work) {
            pool_.parallel_for(count, grain, work);
        };
    }

    sdk::ThreadPool pool_;
    std::string method_;
    std::uint32_t most_frames_;
    std::unique_ptr<Session> session_;
    std::uint32_t camera_ = 0, fed_ = 0;
    std::size_t pixels_ = 0;
};

} // namespace toile::boundary

// Kind toile.body_source/1, fed with a scan, and toile.body_fit/1: the clean surface and its parts.
#include "core/error.h"
#include "mannequin_scan/part_body.h"
#include "mannequin_scan/scan_session.h"
#include "sdk/body_fit.h"
#include "sdk/body_source.h"
#include "sdk/plugin.h"
#include "sdk/views.h"

#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace scan = toile::mannequin_scan;
using toile::geometry::TriangleMesh;

class MannequinScan {
  public:
    static constexpr sdk::Info info{.id = "toile.mannequin_scan",
                                    .name = "A mannequin's or customer's scan, cleaned up",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::BodySource>;
    using Extensions = sdk::Kinds<sdk::BodyFit>;

    explicit MannequinScan(sdk::Host) {}

    toile_body_source_info describe() {
        return {sizeof(toile_body_source_info), TOILE_SOURCE_SCAN, nullptr};
    }

    void begin(const toile_body_source_setup&, sdk::Job job) {
        end();
        begun_ = true;
        job.progress(1.0);
    }

    toile_status feed(const toile_body_source_input& input) {
        if (!begun_) throw sdk::bad_argument("feed: called before begin");
        if (input.scan == nullptr) throw sdk::bad_argument("feed: a scan is wanted, not pictures");
        clean_.reset();
        person_.reset();
        given_ = mesh_of(*input.scan);
        const auto colors = sdk::span_of<scan::Rgba>(input.scan->colors, "scan.colors");
        if (!colors.empty() && colors.size() != given_->positions.size())
            throw sdk::bad_argument("scan.colors: not as many as positions");
        colors_.assign(colors.begin(), colors.end());
        return TOILE_OK;
    }

    void fit(const toile_body_fit_options&, sdk::Job job) {
        if (!given_) throw sdk::bad_argument("fit: nothing was fed");
        job.progress(0.05);
        try {
            clean_ = scan::clean_scan(*given_, colors_);
            job.progress(0.9);
            if (clean_->parts) person_ = std::make_unique<scan::PartBody>(*clean_, ++revision_);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
        job.progress(1.0);
    }

    std::uint32_t result(const sdk::SizedArray<toile_person>& people) {
        if (!person_ || people.size() == 0) return 0;
        toile_person& person = people[0];
        person.has_new_body = 1;
        person.body = &person_->abi();
        person.state.person_id = 1;
        person.state.tracking = TOILE_TRACKING_TRACKED;
        person.state.body_revision = person_->abi().revision;
        const auto joints =
            sdk::span_of<toile_joint>(person.joints, "people.joints", TOILE_JOINT_COUNT);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            joints[j] = {};
            std::copy_n(person_->joints()[j].data(), 3, joints[j].position);
            joints[j].rotation[3] = 1.0f;
            joints[j].confidence = 0.5f;
        }
        return 1;
    }

    void fitted_surface(std::uint32_t instant, toile_mesh_sink& sink) {
        if (!clean_ || instant != 0) throw sdk::bad_argument("instant: nothing is fitted for it");
        const TriangleMesh& mesh = clean_->clean.mesh;
        toile_mesh_buffers out{};
        out.size = sizeof(out);
        check(sink.begin(&sink, static_cast<std::uint32_t>(mesh.positions.size()),
                         static_cast<std::uint32_t>(mesh.triangles.size()), &out));
        const auto positions = sdk::span_of<sdk::Float3>(out.positions, "sink.positions");
        for (std::size_t v = 0; v < positions.size(); ++v)
            std::copy_n(mesh.positions[v].data(), 3, positions[v].data());
        const auto corners = sdk::span_of<sdk::Triangle>(out.triangles, "sink.triangles");
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), corners.begin());
        const auto colors = sdk::span_of<scan::Rgba>(out.colors, "sink.colors");
        std::copy(clean_->colors.begin(), clean_->colors.end(), colors.begin());
        check(sink.commit(&sink));
    }

    std::string fit_report() {
        if (!clean_) throw sdk::bad_argument("report: nothing is fitted");
        return scan::report_of(*clean_).dump();
    }

    void end() {
        begun_ = false;
        person_.reset();
        clean_.reset();
        given_.reset();
        colors_.clear();
    }

  private:
    static void check(toile_status status) {
        if (status < 0) throw sdk::Failure(status, "the mesh sink refused the surface");
    }

    static TriangleMesh mesh_of(const toile_mesh& given) {
        TriangleMesh out;
        for (const auto& p : sdk::span_of<sdk::Float3>(given.positions, "scan.positions"))
            out.positions.emplace_back(p[0], p[1], p[2]);
        for (const auto& t : sdk::span_of<sdk::Triangle>(given.triangles, "scan.triangles")) {
            for (const auto v : t)
                if (v >= out.positions.size())
                    throw sdk::bad_argument("scan.triangles: an index is out of range");
            out.triangles.push_back(t);
        }
        return out;
    }

    bool begun_ = false;
    std::optional<TriangleMesh> given_;
    std::vector<scan::Rgba> colors_;
    std::optional<scan::CleanScan> clean_;
    std::unique_ptr<scan::PartBody> person_;
    std::uint64_t revision_ = 0;
};

} // namespace

TOILE_PLUGIN(mannequin_scan, MannequinScan)

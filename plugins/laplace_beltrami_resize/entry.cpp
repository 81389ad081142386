// Kind toile.resizer/1.
#include "core/error.h"
#include "geometry/mesh.h"
#include "laplace_beltrami_resize/follow_body.h"
#include "laplace_beltrami_resize/strip_resize.h"
#include "laplace_beltrami_resize/trunk.h"
#include "sdk/plugin.h"
#include "sdk/resizer.h"
#include "sdk/thread_pool.h"
#include "sdk/views.h"

namespace {

namespace sdk = toile::sdk;
namespace resize = toile::laplace_beltrami_resize;
using toile::geometry::TriangleMesh;

class LaplaceBeltramiResize {
  public:
    static constexpr sdk::Info info{.id = "toile.laplace_beltrami_resize",
                                    .name = "Abdomen to a customer's by strips and ellipses",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Resizer>;

    explicit LaplaceBeltramiResize(sdk::Host host) : pool_(host) {}

    void resize(const toile_resize_request& request, toile_view_mut positions, sdk::Job job) {
        const bool by_body = request.body_before != nullptr && request.body_after != nullptr;
        if (by_body == (request.target != nullptr))
            throw sdk::bad_argument("request: either a target, or a body before and after");
        const TriangleMesh subject = mesh_of(request.subject, "subject");
        const auto out =
            sdk::span_of<sdk::Float3>(positions, "positions", subject.positions.size());
        std::vector<toile::Vec3f> places;
        try {
            places = by_body ? followed(request, subject, job) : stripped(request, subject, job);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
        for (std::size_t v = 0; v < places.size(); ++v)
            std::copy_n(places[v].data(), 3, out[v].data());
        job.progress(1.0);
    }

  private:
    static TriangleMesh mesh_of(const toile_mesh* given, const char* name) {
        if (given == nullptr) throw sdk::bad_argument(std::string(name) + ": null");
        TriangleMesh out;
        for (const auto& p : sdk::span_of<sdk::Float3>(
                 given->positions, (std::string(name) + ".positions").c_str())) {
            out.positions.emplace_back(p[0], p[1], p[2]);
            if (!out.positions.back().allFinite())
                throw sdk::bad_argument(std::string(name) + ".positions: not finite");
        }
        for (const auto& t : sdk::span_of<sdk::Triangle>(
                 given->triangles, (std::string(name) + ".triangles").c_str())) {
            for (const auto v : t)
                if (v >= out.positions.size())
                    throw sdk::bad_argument(std::string(name) + ".triangles: out of range");
            out.triangles.push_back(t);
        }
        if (out.triangles.empty()) throw sdk::bad_argument(std::string(name) + ": no triangles");
        return out;
    }

    static std::vector<float> region_of(const toile_view& given, const TriangleMesh& mesh,
                                        const char* name) {
        if (given.count == 0) return resize::abdomen_region(mesh);
        const auto rows = sdk::span_of<float>(given, name, mesh.positions.size());
        return {rows.begin(), rows.end()};
    }

    static std::vector<toile::Vec3f> stripped(const toile_resize_request& request,
                                              const TriangleMesh& subject, sdk::Job& job) {
        const TriangleMesh target = mesh_of(request.target, "target");
        const auto region = region_of(request.region, subject, "region");
        job.progress(0.4);
        const auto target_region = region_of(request.target_region, target, "target_region");
        job.progress(0.8);
        return resize::resize_strips(subject, region, target, target_region,
                                     request.strips == 0 ? resize::kStrips : request.strips);
    }

    std::vector<toile::Vec3f> followed(const toile_resize_request& request,
                                       const TriangleMesh& subject, sdk::Job& job) {
        const TriangleMesh before = mesh_of(request.body_before, "body_before");
        const TriangleMesh after = mesh_of(request.body_after, "body_after");
        if (before.triangles != after.triangles)
            throw sdk::bad_argument("body_after: not of the topology of body_before");
        job.progress(0.1);
        const auto rows = [this](std::uint32_t count, std::uint32_t grain, const auto& work) {
            pool_.parallel_for(count, grain, work);
        };
        return resize::follow_body(subject, before, after.positions, rows);
    }

    sdk::ThreadPool pool_;
};

} // namespace

TOILE_PLUGIN(laplace_beltrami_resize, LaplaceBeltramiResize)

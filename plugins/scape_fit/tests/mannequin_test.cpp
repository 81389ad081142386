// An analytic figure, scanned: where its girths are known, those of the fitted body are the same.
#include "geometry/slice.h"
#include "people.h"
#include "support/mannequin.h"

namespace toile::scape_fit {
namespace {

using test::Limb;
using test::Mannequin;
using test::Stretch;

constexpr float kSpacing = 0.006f; // of the scan's vertices, metres
constexpr double kChords = 0.001;  // metres: so much a polygon is shorter than its ellipse
constexpr double kClose = 0.002;   // metres: so near are girths of the fitted body

const geometry::TriangleMesh& scan() {
    static const geometry::TriangleMesh kScan = Mannequin().mesh(kSpacing);
    return kScan;
}

struct Known {
    const char* name;
    Limb limb;
    Stretch stretch;
    double within_m; ///< of the fitted body
};

std::vector<Known> known_sections() {
    std::vector<Known> out = {
        {"hip", Mannequin::trunk(), Mannequin::kHip, kClose},
        {"waist", Mannequin::trunk(), Mannequin::kWaist, kClose},
        {"bust", Mannequin::trunk(), Mannequin::kBust, kClose},
        {"head", Mannequin::head(), Mannequin::kHead, 0.005}, // a body has ears there
    };
    for (const float side : {1.0f, -1.0f}) {
        out.push_back({"thigh", Mannequin::thigh(side), Mannequin::kThigh, kClose});
        out.push_back({"calf", Mannequin::shin(side), Mannequin::kCalf, kClose});
        out.push_back({"shin", Mannequin::shin(side), Mannequin::kShin, kClose});
        out.push_back({"upper arm", Mannequin::upper_arm(side), Mannequin::kUpperArm, kClose});
        out.push_back({"wrist", Mannequin::lower_arm(side), Mannequin::kWrist, kClose});
    }
    return out;
}

/// A tape pulled tight around what of a surface is nearest to the middle of a known section.
double girth_at(const geometry::TriangleMesh& mesh, const Known& known, float at) {
    const Vec3f middle = known.limb.middle(known.stretch, at);
    const auto plane = geometry::Plane::through(middle, known.limb.along);
    double out = 0.0;
    float nearest = 1.0f;
    for (const geometry::Loop& loop : geometry::slice(mesh.positions, mesh.triangles, plane)) {
        Vec3f mean = Vec3f::Zero();
        for (const Vec3f& p : loop.points)
            mean += p / static_cast<float>(loop.points.size());
        if ((mean - middle).norm() >= nearest) continue;
        nearest = (mean - middle).norm();
        out = geometry::hull_girth(loop.points, plane);
    }
    return out;
}

/// Compares at both ends of each stretch, where another section begins, and between.
template <class Within>
void expect_known_girths(const geometry::TriangleMesh& mesh, const Within& within) {
    double worst = 0.0;
    for (const Known& known : known_sections())
        for (const float share : {0.1f, 0.5f, 0.9f}) {
            const float at = known.stretch.from + share * (known.stretch.to - known.stretch.from);
            const double off = girth_at(mesh, known, at) - known.stretch.girth();
            EXPECT_LT(std::abs(off), within(known)) << known.name << " at " << at;
            if (known.within_m <= kClose) worst = std::max(worst, std::abs(off));
        }
    std::cout << "sections without the head: at most " << 1000.0 * worst << " mm off\n";
}

TEST(MannequinFit, TheScanHasTheGirthsThatItsSectionsHave) {
    EXPECT_TRUE(geometry::check_topology(scan().positions, scan().triangles).closed());
    expect_known_girths(scan(), [](const Known&) { return kChords; });
}

TEST(MannequinFit, TheFittedBodyHasTheSameGirthsAtTheSamePlaces) {
    FitSession session(adult());
    session.begin({});
    session.add_scan(scan());
    session.fit({}, &serial_rows);
    const geometry::TriangleMesh body{session.surface(0).positions, {}, adult().level(0).triangles};
    expect_known_girths(body, [](const Known& known) { return known.within_m; });
}

} // namespace
} // namespace toile::scape_fit

// People to test a body space on, made outside of it: MakeHuman's own mesh, rig and weights.
//
// Nothing here passes through the template, the 22-joint weights or the shape space of avatars:
// 13,380 vertices of the source mesh, moved by the 163 bones of the source rig with linear blend
// skinning. Only the 22 joints' places and rotations, which truth is told in, are ours.
#pragma once

#include "body/avatar_shape.h"
#include "body/body_model.h"
#include "geometry/slice.h"

namespace toile::body {

inline constexpr double kBodyDensity = 985.0; ///< kg/m3, lungs half filled

struct TestPersonBone {
    std::string name;
    int parent = -1;            ///< before this one
    Vec3f head = Vec3f::Zero(); ///< at rest, metres
};

/// Where a girth is taken: a plane that moves with a joint, and the curve in it that is meant.
struct GirthPlane {
    std::string name; ///< "waist_girth", "left_thigh_girth"
    Joint joint = Joint::hips;
    Vec3f point = Vec3f::Zero();   ///< middle of the curve at rest, metres
    Vec3f normal = Vec3f::UnitY(); ///< unit, at rest
    double girth = 0.0;            ///< of this person at rest: convex, metres
};

/// Convex girth of a surface in a plane that was carried along by its joint (`moved` maps rest
/// points of the joint into the world): of the closed curves the one whose middle is nearest to the
/// plane's point. Nothing when the plane meets no closed curve within 15 cm of it.
[[nodiscard]] std::optional<double> girth_in(const GirthPlane& plane, const RigidTransform& moved,
                                             std::span<const Vec3f> positions,
                                             std::span<const Triangle> triangles);

/// The rest pose is the source's own: arms out and down, forearms bent forward; feet on y = 0,
/// facing +Z; metres.
struct TestPerson {
    std::string id;
    bool woman = false;
    ShapeRecipe recipe;          ///< what it was made of
    double displacement_m = 0.0; ///< 95 % of the smooth displacements are smaller
    double volume_m3 = 0.0;
    double bmi = 0.0;                             ///< volume times kBodyDensity by stature squared
    geometry::TriangleMesh rest;                  ///< closed; with normals
    std::vector<Part> parts;                      ///< (nv)
    std::vector<TestPersonBone> bones;            ///< (163)
    std::vector<std::vector<BoneWeight>> weights; ///< (nv) four at most, sum 1
    Skeleton skeleton;                            ///< the 22 joints at rest
    geometry::TriangleMesh eyes;                  ///< eyeballs, held by the head; for pictures only
    std::map<std::string, std::uint32_t> landmarks; ///< name -> vertex
    std::vector<GirthPlane> girths;
    std::map<std::string, double> lengths; ///< at rest, metres: stature, crotch_height ...
};

/// Poses one person; not movable, borrows it.
class TestPersonPoser {
  public:
    /// \throw Error when the rig lacks a bone of ours
    explicit TestPersonPoser(const TestPerson& person);

    /// Rotations of the 22 joints as for any skeleton of ours. The spine and the neck bend over
    /// several bones, limbs twist along two, so that joints may lie some millimetres from where
    /// forward_kinematics has them; rotations agree.
    void pose(const Pose& pose, const RigidTransform& place = {}) noexcept;

    [[nodiscard]] const JointTransforms& joints() const noexcept { return joints_; }
    [[nodiscard]] std::span<const Vec3f> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<const Vec3f> eyes() const noexcept { return eyes_; }
    /// Rest points of a joint into the world.
    [[nodiscard]] RigidTransform moved(Joint joint) const noexcept;

  private:
    /// What one bone takes from one of our joints.
    enum class Drive : std::uint8_t { none, whole, half, quarter, swing, twist, forearm, wrist };
    struct Driver {
        Drive drive = Drive::none;
        Joint joint = Joint::hips;
        Vec3f axis = Vec3f::Zero(); ///< along the limb at rest, unit
        Vec3f next_axis = Vec3f::Zero();
        Joint next = Joint::hips;
    };
    [[nodiscard]] Quatf local_rotation(const Driver& driver, const Pose& pose) const noexcept;

    const TestPerson& person_;
    std::vector<Driver> drivers_;                                 // (bones)
    std::array<std::array<std::size_t, 2>, kJointCount> heads_{}; // bones whose heads' mean it is
    std::vector<RigidTransform> bones_;                           // (bones) world_from_rest
    std::size_t hips_bone_ = 0, head_bone_ = 0;
    JointTransforms joints_;
    std::vector<Vec3f> positions_;
    std::vector<Vec3f> eyes_;
};

/// Names of the bones whose heads (their mean) are a joint of ours. \throw nothing
[[nodiscard]] std::array<std::string, 2> source_bones(Joint joint);

/// FOLDER/person.json and FOLDER/person.glb (the mesh on its 163 bones). \throw Error
void save_test_person(const TestPerson& person, const std::filesystem::path& folder);
[[nodiscard]] TestPerson load_test_person(const std::filesystem::path& folder);

} // namespace toile::body

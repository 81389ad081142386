// Draws people for testing: random mixtures of MakeHuman's targets, of the held-out families too.
#pragma once

#include "body/test_person.h"

namespace toile::body {

struct TestPeopleOptions {
    std::uint64_t seed = 1;
    /// Use the families of held_out_modifiers.h and smooth displacements. Without: people that the
    /// training could have drawn, though still on the source's mesh and rig.
    bool out_of_model = true;
    int heavy_every = 4; ///< each such person has a BMI over 35; 0: none
    /// 95 % of the displacements along the normals are smaller than a number drawn from here.
    double least_displacement_m = 0.003;
    double most_displacement_m = 0.005;
};

/// Person `number` (0, 1 ...: women and men in turn) of a series; it depends on the seed and its
/// number only. \throw Error when the data lacks a target
[[nodiscard]] TestPerson make_test_person(const MakeHumanData& data, std::uint32_t number,
                                          const TestPeopleOptions& options = {});

/// What a person is made of before its weight is settled. `weight` from -1 (thin) over 0 (average)
/// to 1 (fat) and somewhat beyond.
[[nodiscard]] ShapeRecipe macro_recipe(bool woman, double age, double muscle, double weight,
                                       double height, double proportions);

/// Landmarks, girth planes, lengths and volume of a person whose surface, joints and parts are
/// there. \throw Error when a place cannot be found
void find_test_person_truth(TestPerson& person);

} // namespace toile::body

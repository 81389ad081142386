#include "pipeline/person_fit.h"

namespace toile::pipeline {

garment::FitReport fit_of(DressedPerson& person) {
    garment::FitReport report;
    const body::BodyModel& model = person.body().model();
    report.body = model.id;
    const body::JointTransforms world = transforms_of(person.posed().joints);
    const garment::FitAssessor assessor(
        {model, person.posed().positions, person.posed().normals, world});
    for (const WornGarment& worn : person.garments()) {
        const BoundaryGarment& garment = worn.garment();
        report.garments.push_back(
            assessor.assess({garment.package(), garment.size(), worn.bound, worn.positions,
                             worn.normals, garment.made_on_measurements()},
                            report.failures));
    }
    for (std::string& fault : person.faults())
        report.failures.push_back({garment::FitFailureCode::plugin_failed, "", std::move(fault)});
    return report;
}

} // namespace toile::pipeline

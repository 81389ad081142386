// Which body part each pixel of a recording shows, as files: `toile track --labels`.
#pragma once

#include "apps/picture_folder.h"
#include "pipeline/people_source.h"

namespace toile::apps {

/// Indexed pictures 000000.png ... and labels.json, which tells what the values mean: 16 times a
/// person's place among the frame's people, from 0, plus a body::Part; 0: nobody.
class LabelFolder {
  public:
    /// \throw Error when the tracker does not tell parts or the folder cannot be made
    LabelFolder(const std::filesystem::path& folder, const pipeline::PeopleSource& source,
                std::uint32_t most_people);

    /// The frame that `source` gave last. \throw Error
    void add(pipeline::PeopleSource& source);

  private:
    PictureFolder pictures_;
    pipeline::PartPicture parts_;
    imaging::IndexedImage image_;
};

} // namespace toile::apps

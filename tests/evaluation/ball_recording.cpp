// ball_recording FOLDER [NAME=VALUE ...]: a surface cache of a ball on a stick that is moved about,
// for scenarios that calibrate cameras. radius, frames, seed; low and high: x,y,z of its centre.
#include "core/error.h"
#include "support/ball_motion.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    try {
        if (argc < 2) throw toile::Error("ball_recording FOLDER [NAME=VALUE ...]");
        toile::test::BallMotion motion;
        for (int i = 2; i < argc; ++i) {
            const std::string word = argv[i];
            const auto at = word.find('=');
            const std::string name = word.substr(0, at);
            const char* value = at == std::string::npos ? "" : argv[i] + at + 1;
            const auto place = [&](toile::Vec3f& out) {
                if (std::sscanf(value, "%f,%f,%f", &out.x(), &out.y(), &out.z()) != 3)
                    throw toile::Error(word + ": write x,y,z");
            };
            if (name == "radius")
                motion.radius_m = static_cast<float>(std::atof(value));
            else if (name == "frames")
                motion.frames = std::atoi(value);
            else if (name == "seed")
                motion.seed = static_cast<std::uint64_t>(std::atoll(value));
            else if (name == "low")
                place(motion.low);
            else if (name == "high")
                place(motion.high);
            else
                throw toile::Error(name + ": no such option");
        }
        toile::test::write_ball_motion(argv[1], motion);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}

// Extension toile.parameters/1 for a class P with
//     static constexpr std::array parameters{Parameter{...}, ...};
//     double& parameter(std::size_t index);   // the value of parameters[index]            [main]
// and `using Extensions = Kinds<Parameters>;`. A changed value counts from the next activate.
#pragma once

#include "abi/parameters.h"
#include "sdk/guard.h"
#include "sdk/structs.h"

#include <cmath>
#include <string_view>

namespace toile::sdk {

struct Parameter {
    const char* id;
    std::uint32_t type; ///< TOILE_PARAMETER_*
    const char* unit;   ///< "m", "s", "1"
    const char* text;   ///< one line for people
    double minimum, maximum, default_value;
};

struct Parameters {
    static constexpr const char* id = TOILE_PARAMETERS;

    template <class P>
    static std::uint32_t count(toile_instance*) noexcept {
        return static_cast<std::uint32_t>(P::parameters.size());
    }
    template <class P>
    static toile_status describe(toile_instance* instance, std::uint32_t index,
                                 toile_parameter* out) noexcept {
        return guarded<P>(instance, [&](P&) {
            if (index >= P::parameters.size()) throw bad_argument("index: no such parameter");
            const Parameter& p = P::parameters[index];
            write_struct(out,
                         {sizeof(toile_parameter), p.type, p.id, p.unit, p.text, p.minimum,
                          p.maximum, p.default_value},
                         "out");
        });
    }
    template <class P>
    static toile_status get(toile_instance* instance, const char* name, double* value) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (value == nullptr) throw bad_argument("value: null");
            *value = p.parameter(index_of<P>(name));
        });
    }
    template <class P>
    static toile_status set(toile_instance* instance, const char* name, double value) noexcept {
        return guarded<P>(instance, [&](P& p) {
            const std::size_t index = index_of<P>(name);
            const Parameter& known = P::parameters[index];
            if (!(value >= known.minimum && value <= known.maximum))
                throw bad_argument(std::string(name) + ": outside its range");
            if (known.type != TOILE_PARAMETER_REAL && value != std::floor(value))
                throw bad_argument(std::string(name) + ": must be a whole number");
            p.parameter(index) = value;
        });
    }
    template <class P>
    static constexpr toile_parameters table{
        sizeof(toile_parameters), 0, &count<P>, &describe<P>, &get<P>, &set<P>};

  private:
    template <class P>
    static std::size_t index_of(const char* name) {
        if (name == nullptr) throw bad_argument("id: null");
        for (std::size_t i = 0; i < P::parameters.size(); ++i)
            if (std::string_view(name) == P::parameters[i].id) return i;
        throw bad_argument(std::string(name) + ": no such parameter");
    }
};

} // namespace toile::sdk

// EXPECT_ERROR(statement, "part of the text"): throws toile::Error in one line holding that part.
#pragma once

#include "core/error.h"

#include <gtest/gtest.h>
#include <string>

#define EXPECT_ERROR(statement, part)                                                              \
    do {                                                                                           \
        try {                                                                                      \
            statement;                                                                             \
            ADD_FAILURE() << "no error; expected one with: " << (part);                            \
        } catch (const ::toile::Error& toile_error) {                                              \
            const std::string toile_text = toile_error.what();                                     \
            EXPECT_NE(toile_text.find(part), std::string::npos) << "the error is: " << toile_text; \
            EXPECT_EQ(toile_text.find('\n'), std::string::npos) << "more than one line";           \
        }                                                                                          \
    } while (false)

#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fluxel::test_messages {

/// All words stand in the message.
inline void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is not in: " << message;
  }
}

}  // namespace fluxel::test_messages

#include "io/file/base64.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace tessera { inline namespace abi_0_1 { namespace {

std::string encoded(std::string_view bytes, std::size_t piece) {
  Base64Encoder encoder;
  std::string text;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), piece)))
    text += encoder.encode(bytes.substr(0, piece));
  return text + encoder.finish();
}

TEST(Base64, EncodesTheExamplesOfTheRfc) {  // RFC 4648, section 10
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) {
    for (const std::size_t piece : {1u, 2u, 4u, 9u}) EXPECT_EQ(encoded(bytes, piece), text);
    EXPECT_EQ(base64_decoded(text), bytes);
    EXPECT_EQ(base64_decoded(std::string(text).substr(0, std::string(text).find('='))), bytes);
  }
}

TEST(Base64, EveryByteComesBack) {
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 300; ++size) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    EXPECT_EQ(base64_decoded(encoded(bytes, 1 + size % 7)), bytes);
  }
}

TEST(Base64, MalformedTextIsRefused) {
  for (const char* const text : {"Z", "Zm9vY", "Zg=", "Z===", "Zg==Zg==", "Zm 9v", "Zm9v\n", "Zm9-", "=", "===="})
    EXPECT_FALSE(base64_decoded(text)) << text;
}

}}}  // namespace tessera::abi_0_1

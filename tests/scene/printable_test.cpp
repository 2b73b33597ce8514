#include "scene/printable.h"

#include <gtest/gtest.h>

#include <string>

#include "scene/csv.h"
#include "scene/input_file.h"

namespace hemirad::printable_test {
namespace {

TEST(Printable, LeavesTextAsItIs) {
    EXPECT_EQ(printable("h\u00f6he \u2113 \U0001f4a1 back\\slash"),
              "h\u00f6he \u2113 \U0001f4a1 back\\slash");
}

TEST(Printable, EscapesControlCharacters) {
    EXPECT_EQ(printable("a\nb\x1b[31m\x7f"), "a\\x0ab\\x1b[31m\\x7f");
    EXPECT_EQ(printable("\u009b31m"), "\\xc2\\x9b31m");
}

TEST(Printable, EscapesWhatIsNoUtf8) {
    EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
    EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
    EXPECT_EQ(printable("\xe2\x84"), "\\xe2\\x84");                    // cut short
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
}

TEST(Printable, EscapesWhatReversesOrSeparatesLines) {
    EXPECT_EQ(printable("a\u202etxt.jbo"), "a\\xe2\\x80\\xaetxt.jbo");
    EXPECT_EQ(printable("a\u2028b\u2066c"), "a\\xe2\\x80\\xa8b\\xe2\\x81\\xa6c");
    EXPECT_EQ(printable("a\u061cb\u200ec\u200fd"), "a\\xd8\\x9cb\\xe2\\x80\\x8ec\\xe2\\x80\\x8fd");
    EXPECT_EQ(printable("\u061b\u200d\u2010"), "\u061b\u200d\u2010");
    EXPECT_EQ(printable("\u2027\u202f\u2065\u206a"), "\u2027\u202f\u2065\u206a");  // beside them
}

TEST(Printable, GoesOnAfterABadByte) { EXPECT_EQ(printable("\xe2o\xc3\xb6"), "\\xe2o\xc3\xb6"); }

TEST(InQuotes, CutsWhatIsLongBetweenCharacters) {
    EXPECT_EQ(in_quotes("a\"b"), "\"a\"b\"");
    EXPECT_EQ(in_quotes(std::string(200, 'x')), '"' + std::string(200, 'x') + '"');
    EXPECT_EQ(in_quotes(std::string(199, 'x') + "\u00e4\u00e4"),
              '"' + std::string(199, 'x') + "...\"");
}

TEST(CsvField, QuotesWhatPartsFields) {
    EXPECT_EQ(csv_field("wall"), "wall");
    EXPECT_EQ(csv_field("a,\"b\""), "\"a,\"\"b\"\"\"");
}

/// An apostrophe makes it text.
TEST(CsvField, LeavesNothingForASpreadsheetToCompute) {
    EXPECT_EQ(csv_field("=1+2"), "'=1+2");
    EXPECT_EQ(csv_field("@SUM(A1,A2)"), "\"'@SUM(A1,A2)\"");
    EXPECT_EQ(csv_field("-cmd|' /C calc'!A0"), "'-cmd|' /C calc'!A0");
    EXPECT_EQ(csv_field("+HYPERLINK(A1)"), "'+HYPERLINK(A1)");
    EXPECT_EQ(csv_field("+HYPERLINK(A1) (back)"), "'+HYPERLINK(A1) (back)");
}

TEST(CsvField, LeavesNothingToComputeBehindASemicolonOrTab) {
    EXPECT_EQ(csv_field("a;=HYPERLINK(\"x\")"), "\"a;'=HYPERLINK(\"\"x\"\")\"");
    EXPECT_EQ(csv_field("a;;@SUM(A1);b\t=1"), "a;;'@SUM(A1);b\t'=1");
    EXPECT_EQ(csv_field("=1;+cmd|x"), "'=1;'+cmd|x");
    EXPECT_EQ(csv_field("a;-1+2"), "a;'-1+2");
    EXPECT_EQ(csv_field("a;b=1; c;"), "a;b=1; c;");
}

TEST(CsvField, LeavesNothingToComputeInFullWidth) {
    EXPECT_EQ(csv_field("\uff1dcmd|x"), "'\uff1dcmd|x");
    EXPECT_EQ(csv_field("\uff20SUM"), "'\uff20SUM");
    EXPECT_EQ(csv_field("\uff0bcmd|x"), "'\uff0bcmd|x");
    EXPECT_EQ(csv_field("a;\uff0d1"), "a;'\uff0d1");
    EXPECT_EQ(csv_field("\uff0dx"), "\uff0dx");
    EXPECT_EQ(csv_field("\uff0c\uff1e\uff1f"), "\uff0c\uff1e\uff1f");
}

TEST(CsvField, LeavesDirectionsAsTheyAre) {
    EXPECT_EQ(csv_field("+x"), "+x");
    EXPECT_EQ(csv_field("+x (back)"), "+x (back)");
    EXPECT_EQ(csv_field("-z panel"), "-z panel");
    EXPECT_EQ(csv_field("a=1"), "a=1");
}

}  // namespace
}  // namespace hemirad::printable_test

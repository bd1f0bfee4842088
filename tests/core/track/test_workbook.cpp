#include "core/track/workbook.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/track/bare_track.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/core/made_project.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n";

/// A workbook as Excel writes it: sheets of the given rows (the inner XML of sheetData), texts, and styles 0 (general),
/// 1 (date, built in), 2 (its own format).
struct MadeWorkbook {
  std::vector<std::pair<std::string, std::string>> sheets;  ///< name, rows
  std::vector<std::string> texts = {};
  std::string own_format = "0.000";
  std::string kind = "worksheet";  ///< of the first sheet
  std::string document_type = {};
  std::string target = {};  ///< of every sheet's link, in place of a part of its own

  std::vector<std::pair<std::string, std::string>> parts() const {
    std::string list, links, shared;
    std::vector<std::pair<std::string, std::string>> all;
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      list += fmt::format("<sheet name=\"{}\" sheetId=\"{}\" r:id=\"rId{}\"/>", sheets[i].first, i + 1, i + 1);
      links += fmt::format(
          "<Relationship Id=\"rId{0}\" "
          "Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/{1}\" "
          "Target=\"{2}\"/>",
          i + 1, i == 0 ? kind : "worksheet", target.empty() ? fmt::format("worksheets/sheet{}.xml", i + 1) : target);
      all.emplace_back(fmt::format("xl/worksheets/sheet{}.xml", i + 1),
                       kXml + document_type + "<worksheet><sheetData>" + sheets[i].second + "</sheetData></worksheet>");
    }
    for (const std::string& text : texts) shared += text;
    all.emplace_back("xl/workbook.xml", kXml + ("<workbook><sheets>" + list + "</sheets></workbook>"));
    all.emplace_back("xl/_rels/workbook.xml.rels", kXml + ("<Relationships>" + links + "</Relationships>"));
    all.emplace_back("xl/sharedStrings.xml", kXml + ("<sst>" + shared + "</sst>"));
    all.emplace_back("xl/styles.xml",
                     kXml + fmt::format("<styleSheet><numFmts><numFmt numFmtId=\"164\" formatCode=\"{}\"/>"
                                        "</numFmts><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"14\"/>"
                                        "<xf numFmtId=\"164\"/></cellXfs></styleSheet>",
                                        own_format));
    return all;
  }
};

/// Ten rows from row `first` on, of the given pattern: {0} is the row, {1} i, {2} the square of i.
std::string rows(const std::string& pattern, int first = 2) {
  std::string text;
  for (int i = 0; i < 10; ++i) text += fmt::format(fmt::runtime(pattern), first + i, i, i * i);
  return text;
}

/// t = 0.1 i s in A, x = i² cm in B, below the texts 0 and 1 as the header.
const std::string kHeader = "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c r=\"B1\" t=\"s\"><v>1</v></c></row>";
const std::string kRows =
    rows("<row r=\"{0}\"><c r=\"A{0}\"><v>0.{1}</v></c><c r=\"B{0}\" s=\"2\"><v>{2}</v></c></row>");
const std::vector<std::string> kTexts = {"<si><t>t (s)</t></si>", "<si><r><t>x </t></r><r><t>(cm)</t></r></si>"};

struct Folder {
  tests::TempDir temp;
  std::filesystem::path write(const MadeWorkbook& book) const {
    return tests::write_zip(temp / "made.xlsx", book.parts());
  }
  core::TrackData read(const MadeWorkbook& book, const std::string& column = "") const {
    return core::read_track(write(book), {}, column);
  }
};

void check_motion(const core::TrackData& track) {
  REQUIRE(track.t_s.size() == 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto n = static_cast<double>(i);
    CHECK(std::abs(track.t_s[i] - 0.1 * n) < 1e-12);  // decimal fractions
    CHECK(std::abs(track.x_m[i] - 0.01 * n * n) < 1e-12);
  }
}

}  // namespace

TEST_CASE("a workbook's numbers, shared texts and units are read as those of an exported table") {
  const Folder folder;
  const core::TrackData track = folder.read({{{"Data", kHeader + kRows}}, kTexts});
  check_motion(track);
  CHECK(tests::note_of<core::SheetTaken>(track.notes) == nullptr);
  CHECK_FALSE(core::runs_in(folder.temp / "made.xlsx").empty());
}

TEST_CASE("a workbook's inline texts, titles, formulas, empty and erroneous cells, and a table away from the corner") {
  const Folder folder;
  const std::string text =
      "<row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>Cart \"7\", measured twice</t></is></c></row>"
      "<row r=\"4\"><c r=\"C4\" t=\"inlineStr\"><is><t>Zeit (ms)</t></is></c><c r=\"D4\" t=\"str\"><v>Weg (mm)</v></c>"
      "<c r=\"E4\" t=\"inlineStr\"><is><t>remark</t></is></c></row>" +
      rows(
          "<row r=\"{0}\"><c r=\"C{0}\"><v>{1}00</v></c><c r=\"D{0}\"><f>B{0}^2</f><v>{2}0</v></c>"
          "<c r=\"E{0}\" t=\"e\"><v>#DIV/0!</v></c></row>",
          5) +
      "<row r=\"15\"><c r=\"C15\"/></row>";
  check_motion(folder.read({{{"Data", text}}}));
}

TEST_CASE("cells and rows without addresses follow one another, and names may have a prefix") {
  const Folder folder;
  const std::string text = rows("<x:row><x:c><x:v>0.{1}</x:v></x:c><x:c><x:v>{2}E-2</x:v></x:c></x:row>");
  check_motion(folder.read({{{"Data", text}}}));
}

TEST_CASE("of several sheets the first that has a table is read, and a note names it") {
  const Folder folder;
  const std::string settings =
      "<row r=\"1\"><c r=\"A1\"><v>0.2</v></c><c r=\"B1\"><v>30</v></c></row><row r=\"2\"><c r=\"A2\" "
      "t=\"s\"><v>0</v></c></row>";
  MadeWorkbook book{{{"Settings", settings}, {"Run 1", kHeader + kRows}, {"Run 2", kHeader}}, kTexts};
  const core::TrackData track = folder.read(book);
  check_motion(track);
  const auto* const taken = tests::note_of<core::SheetTaken>(track.notes);
  REQUIRE(taken != nullptr);
  CHECK(taken->sheet == "Run 1");
  book.sheets[0].second = kHeader + kRows;
  book.kind = "chartsheet";
  CHECK(tests::note_of<core::SheetTaken>(folder.read(book).notes)->sheet == "Run 1");
}

TEST_CASE("dates and times of day are not times") {
  const Folder folder;
  const std::string dated =
      rows("<row r=\"{0}\"><c r=\"A{0}\" s=\"1\"><v>4500{1}</v></c><c r=\"B{0}\"><v>{2}</v></c></row>");
  CHECK_THROWS_WITH(folder.read({{{"Data", kHeader + dated}}, kTexts}),
                    Contains("10 cells with dates or times of day") && Contains("86400"));
  const std::string of_day = rows(
      "<row r=\"{0}\"><c r=\"A{0}\" s=\"2\"><v>0.{1}</v></c><c r=\"B{0}\"><v>{2}</v></c><c "
      "r=\"C{0}\"><v>1</v></c></row>");
  const std::string header =
      "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c r=\"B1\" t=\"s\"><v>1</v></c><c r=\"C1\" "
      "t=\"s\"><v>2</v></c></row>";
  std::vector<std::string> texts = kTexts;
  texts.push_back("<si><t>day</t></si>");
  for (const char* const format : {"hh:mm:ss", "[h]:mm", "[mm]", "yyyy\\-mm\\-dd;@", "mm:ss.0"}) {
    INFO(format);
    CHECK_THROWS_WITH(folder.read({{{"Data", header + of_day}}, texts, format}, "x (cm)"), Contains("times of day"));
  }
  for (const char* const format : {"0.00", "[Red]0.0", "0.0 &quot;days&quot;", "General", "0.00E+00", "0\\d"}) {
    INFO(format);
    check_motion(folder.read({{{"Data", header + of_day}}, texts, format}, "x (cm)"));
  }
  // Beside a column of times the date is no matter.
  const std::string beside = rows(
      "<row r=\"{0}\"><c r=\"A{0}\"><v>0.{1}</v></c><c r=\"B{0}\"><v>{2}</v></c><c r=\"C{0}\" "
      "s=\"1\"><v>45000</v></c></row>");
  check_motion(folder.read({{{"Data", header + beside}}, texts}));
}

TEST_CASE("bad workbooks give one clear error each") {
  const Folder folder;
  const auto message = [&](const std::string& sheet) {
    try {
      folder.read({{{"Data", sheet}}, kTexts});
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(message("<row r=\"1\"><c r=\"A1\" t=\"s\"><v>7</v></c></row>"), Contains("text 7 of 2"));
  CHECK_THAT(message("<row r=\"1\"><c r=\"A1\" t=\"s\"><v>-1</v></c></row>"),
             Contains("\"-1\" where a number should be"));
  CHECK_THAT(message("<row r=\"1\"><c r=\"A1\"><v>soon</v></c></row>"), Contains("\"soon\" where a number should be"));
  CHECK_THAT(message("<row r=\"2\"/><row r=\"1\"/>"), Contains("row \"1\" after row 2"));
  CHECK_THAT(message("<row r=\"99999999\"/>"), Contains("row \"99999999\""));
  CHECK_THAT(message("<row r=\"1\"><c r=\"ZZZZ1\"/></row>"), Contains("out of order"));
  CHECK_THAT(message("<row r=\"1\"><c r=\"B1\"/><c r=\"A1\"/></row>"), Contains("\"A1\" out of order"));
  CHECK_THAT(message("<row r=\"1\"><c"), Contains("sheet1.xml:2: found XML that breaks off"));
  CHECK_THAT(message(""), Contains("sheet \"Data\"") && Contains("no line with two numbers"));
  CHECK_THAT(message(kHeader + rows("<row r=\"{0}\"><c r=\"A{0}\"><v>0.{1}</v></c><c r=\"B{0}\"><v>{2}</v></c></row>") +
                     "<row r=\"12\"><c r=\"A12\" t=\"s\"><v>0</v></c></row>"),
             Contains("sheet \"Data\":12: column 1: found \"t (s)\""));
  CHECK_THROWS_WITH(folder.read({{{"Data", kHeader}}, kTexts, "0", "worksheet", "<!DOCTYPE x [<!ENTITY a \"b\">]>"}),
                    Contains("document type"));
  CHECK_THROWS_WITH(folder.read({{{"Chart", ""}}, {}, "0", "chartsheet"}), Contains("without a worksheet"));
  const auto file = tests::write_zip(folder.temp / "part.xlsx", {{"xl/workbook.xml", "<workbook/>"}});
  CHECK_THROWS_WITH(core::read_track(file, {}, ""), Contains("workbook.xml.rels: found no such part"));
  base::write_file(file, base::read_file(file).substr(0, 40));
  CHECK_THROWS_WITH(core::read_track(file, {}, ""), Contains("zip archive that cannot be read"));
}

TEST_CASE("a workbook that unpacks to more than a table is refused before it fills the memory") {
  const Folder folder;
  const std::string blanks(core::kMostPartBytes, ' ');
  CHECK_THROWS_WITH(folder.read({{{"Data", blanks}}}), Contains("sheet1.xml: found more than 33554432 bytes"));
  std::string far;  // 16,000 columns in each of 5000 rows
  for (int row = 1; row <= 5000; ++row) {
    far += fmt::format("<row r=\"{0}\"><c r=\"A{0}\"><v>1</v></c><c r=\"WQK{0}\"><v>1</v></c></row>", row);
  }
  CHECK_THROWS_WITH(folder.read({{{"Data", far}}}), Contains("more than 67108864 bytes as text"));
}

TEST_CASE("a workbook of a thousand sheets is read, one of more is refused") {
  const Folder folder;
  MadeWorkbook book;
  for (std::size_t i = 1; i < core::kMostSheets; ++i) book.sheets.emplace_back(fmt::format("Empty {}", i), "");
  book.sheets.emplace_back("Last", kHeader + kRows);
  book.texts = kTexts;
  const core::TrackData track = folder.read(book);
  check_motion(track);
  CHECK(tests::note_of<core::SheetTaken>(track.notes)->sheet == "Last");
  book.sheets.emplace_back("One more", "");
  CHECK_THROWS_WITH(folder.read(book), Contains("found a workbook of 1001 sheets, expected at most 1000"));
}

TEST_CASE("the sheets of a workbook are unpacked up to a sum, and a part that several name only once") {
  const Folder folder;
  const std::string large = kXml + ("<worksheet><sheetData/>" + std::string(std::size_t{30} << 20, ' ') +
                                    "</worksheet>");  // nine are more than 256 MiB
  MadeWorkbook book;
  for (int i = 1; i <= 9; ++i) book.sheets.emplace_back(fmt::format("Sheet {}", i), "");
  const auto read_with_large = [&](int count) {
    const auto file = folder.write(book);
    zip_t* const zip = zip_open(file.c_str(), 0, nullptr);
    REQUIRE(zip != nullptr);
    for (int i = 1; i <= count; ++i) {
      const auto index = zip_file_add(zip, fmt::format("xl/worksheets/sheet{}.xml", i).c_str(),
                                      zip_source_buffer(zip, large.data(), large.size(), 0), ZIP_FL_OVERWRITE);
      REQUIRE(index >= 0);
      REQUIRE(zip_set_file_compression(zip, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE, 1) == 0);
    }
    REQUIRE(zip_close(zip) == 0);
    core::read_track(file, {}, "");
  };
  CHECK_THROWS_WITH(read_with_large(9), Contains("found sheets of more than 268435456 bytes") && Contains("as CSV"));
  book.target = "worksheets/sheet1.xml";
  CHECK_THROWS_WITH(read_with_large(1), Contains("no line with two numbers"));
}

TEST_CASE("the name of a part is cleaned and cut before a message shows it") {
  const Folder folder;
  MadeWorkbook book{{{"Data", kHeader + kRows}}, kTexts};
  book.target = "a&#27;[31m&#10;b&quot;" + std::string(10'000, 'c');
  try {
    folder.read(book);
    FAIL("no such part");
  } catch (const base::InputError& error) {
    const std::string message = error.what();
    CHECK_THAT(message, Contains("xl/a [31m b ccc") && Contains("no such part"));
    CHECK(message.find_first_of("\x1b\n\"") == std::string::npos);
    CHECK(message.size() < 1000);
  }
}

TEST_CASE("a blank between the runs of a text belongs to it, a cell of blanks alone is empty") {
  const Folder folder;
  const std::vector<std::string> texts = {
      "<si>\n<r><t>Time</t></r><r><t xml:space=\"preserve\"> </t></r><r><t>(s)</t></r>\n</si>", kTexts[1],
      "<si><t xml:space=\"preserve\"> </t></si>"};
  check_motion(folder.read({{{"Data", kHeader + kRows}}, texts}));
  CHECK_THROWS_WITH(folder.read({{{"Data", kHeader + kRows}}, texts}, "none"), Contains("\"Time (s)\""));
  const std::string blank = rows(
      "<row r=\"{0}\"><c r=\"A{0}\"><v>0.{1}</v></c><c r=\"B{0}\"><v>{2}</v></c><c r=\"C{0}\"><v>\n</v></c>"
      "<c r=\"D{0}\" t=\"s\"><v>2</v></c></row>");
  check_motion(folder.read({{{"Data", kHeader + blank}}, texts}));
}

TEST_CASE("spreadsheets of other kinds are refused with what to save instead") {
  const tests::TempDir folder;
  const auto ods = tests::write_zip(folder / "a.ods", {{"mimetype", "application/vnd.oasis.opendocument.spreadsheet"},
                                                       {"content.xml", "<office:document-content/>"}});
  CHECK_THROWS_WITH(core::read_track(ods, {}, ""), Contains("OpenDocument file (.ods)") && Contains("CSV or .xlsx"));
  const auto binary = tests::write_zip(folder / "a.xlsb", {{"xl/workbook.bin", "1"}});
  CHECK_THROWS_WITH(core::read_track(binary, {}, ""), Contains("(.xlsb)") && Contains("CSV or .xlsx"));
  const auto old = tests::write_text(folder / "a.xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1");
  CHECK_THROWS_WITH(core::read_track(old, {}, ""), Contains("Excel file (.xls)") && Contains(".xlsx"));
}

#include <signorini/lcp/io/matrix_market.h>

#include "tests/lcp/temporary_folder.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <sys/resource.h>

namespace signorini::lcp {
namespace {

const std::string kGeneral = "%%MatrixMarket matrix coordinate real general\n";
const std::string kSymmetric = "%%MatrixMarket matrix coordinate real symmetric\n";
const std::string kArray = "%%MatrixMarket matrix array real general\n";

const std::string kRubbishEntry("2 2 1\n1 1 \0\x01\xff\n", 14);
const std::string kLongWord(100, 'x');
const std::string kCutWord(40, 'x');

CoordinateMatrix read_coordinates(const std::string& text) {
  const TemporaryFolder folder;
  return read_coordinate_matrix(folder.write("W.mtx", text));
}

Matrix read_values(const std::string& text) {
  const TemporaryFolder folder;
  return read_array(folder.write("q.mtx", text));
}

/// "NAME:LINE: message" of the error, the folder cut off; "" if the text was read.
template <typename Read>
std::string error_of(const char* name, const std::string& text, const Read& read) {
  const TemporaryFolder folder;
  const auto file = folder.write(name, text);
  try {
    (void)read(file);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), file);
    const std::string what = error.what();
    EXPECT_EQ(what.find(file.string() + (error.line() > 0 ? ":" : ": ")), 0U) << what;
    return what.substr(folder.path().string().size() + 1);
  }
  return "";
}

std::string coordinate_error(const std::string& text) {
  return error_of("W.mtx", text, read_coordinate_matrix);
}

std::string array_error(const std::string& text) {
  return error_of("q.mtx", text, read_array);
}

TEST(MatrixMarket, ReadsASymmetricMatrixIntoBothTriangles) {
  const CoordinateMatrix matrix = read_coordinates(kSymmetric + "2 2 3\n1 1 1\n2 1 -0.5\n2 2 3\n");
  EXPECT_TRUE(matrix.symmetric);
  EXPECT_EQ(Matrix(to_sparse(matrix)), (Matrix(2, 2) << 1.0, -0.5, -0.5, 3.0).finished());
}

TEST(MatrixMarket, ReadsAGeneralMatrixInAnyOrder) {
  const Matrix expected = (Matrix(2, 3) << 0.0, 2.0, 0.0, 4.0, 0.0, -6e-300).finished();
  EXPECT_EQ(Matrix(to_sparse(read_coordinates(kGeneral + "2 3 3\n2 3 -6e-300\n1 2 2\n2 1 +4\n"))),
            expected);
}

TEST(MatrixMarket, ReadsAnArrayByColumns) {
  EXPECT_EQ(read_values(kArray + "2 2\n1\n2\n3\n4\n"),
            (Matrix(2, 2) << 1.0, 3.0, 2.0, 4.0).finished());
}

TEST(MatrixMarket, TakesCommentsBlankLinesTabsCrLfAndNoLastNewline) {
  EXPECT_EQ(read_values("%%MatrixMarket MATRIX Array REAL General\r\n% a comment\r\n%\r\n\r\n"
                        "2\t1\r\n\r\n 1.5 \r\n-2"),
            Vector(Eigen::Vector2d(1.5, -2.0)));
}

TEST(MatrixMarket, ReadsEmptyMatrices) {
  EXPECT_EQ(read_values(kArray + "0 1\n").rows(), 0);
  EXPECT_EQ(read_coordinates(kGeneral + "0 0 0\n").rows, 0);
  EXPECT_EQ(Matrix(to_sparse(read_coordinates(kGeneral + "2 2 0\n"))), Matrix::Zero(2, 2));
}

struct Refusal {
  const char* name;
  std::string text;
  std::string message;
};

void PrintTo(const Refusal& refusal, std::ostream* stream) {
  *stream << refusal.name;
}

class RefusesCoordinates : public testing::TestWithParam<Refusal> {};

TEST_P(RefusesCoordinates, NamingLineAndExpectation) {
  EXPECT_EQ(coordinate_error(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    MatrixMarket, RefusesCoordinates,
    testing::Values(
        Refusal{"EmptyFile", "", "W.mtx: expected a '%%MatrixMarket' header, found an empty file"},
        Refusal{"NoHeader", "2 2 1\n1 1 1\n",
                "W.mtx:1: expected a '%%MatrixMarket' header, found '2'"},
        Refusal{"ArrayInstead", kArray + "1 1\n1\n",
                "W.mtx:1: MatrixMarket header: expected 'coordinate', found 'array'"},
        Refusal{"Complex", "%%MatrixMarket matrix coordinate complex general\n",
                "W.mtx:1: MatrixMarket header: expected 'real', found 'complex'"},
        Refusal{"Skew", "%%MatrixMarket matrix coordinate real skew-symmetric\n",
                "W.mtx:1: MatrixMarket header: expected 'general' or 'symmetric', found "
                "'skew-symmetric'"},
        Refusal{"HeaderCutShort", "%%MatrixMarket matrix",
                "W.mtx:1: MatrixMarket header: expected 'coordinate', found the end of the line"},
        Refusal{"NoSizeLine", kGeneral + "% only a comment\n",
                "W.mtx:2: expected the size line, found the end of the file"},
        Refusal{"SizeLineTooShort", kGeneral + "2 2\n",
                "W.mtx:2: entries: expected an integer from 0 to 2147483647, found the end of the "
                "line"},
        Refusal{"SizeLineTooLong", kGeneral + "2 2 1 7\n",
                "W.mtx:2: expected the end of the line after the sizes, found '7'"},
        Refusal{"NegativeSize", kGeneral + "-2 2 1\n",
                "W.mtx:2: rows: expected an integer from 0 to 2147483647, found '-2'"},
        Refusal{"SizeOverflows", kGeneral + "99999999999999999999 2 1\n",
                "W.mtx:2: rows: expected an integer from 0 to 2147483647, found "
                "'99999999999999999999'"},
        Refusal{"SizeNotAnInteger", kGeneral + "2.0 2 1\n",
                "W.mtx:2: rows: expected an integer from 0 to 2147483647, found '2.0'"},
        Refusal{"SymmetricNotSquare", kSymmetric + "2 3 0\n",
                "W.mtx:2: a symmetric matrix must be square, found 2 x 3"},
        Refusal{"Truncated", kGeneral + "2 2 3\n1 1 1\n2 2 1\n",
                "W.mtx:4: the size line declares 3 entries, the file ends after 2"},
        Refusal{"CutInALine", kGeneral + "2 2 2\n1 1 1\n2 2",
                "W.mtx:4: value: expected a number, found the end of the line"},
        Refusal{"OneEntryMore", kGeneral + "2 2 1\n1 1 1\n2 2 1\n",
                "W.mtx:4: expected the end of the file after the 1 entries that the size line "
                "declares, found '2 2 1'"},
        Refusal{"NotANumber", kGeneral + "2 2 1\n1 1 abc\n",
                "W.mtx:3: value: expected a number, found 'abc'"},
        Refusal{"HalfANumber", kGeneral + "2 2 1\n1 1 1.5x\n",
                "W.mtx:3: value: expected a number, found '1.5x'"},
        Refusal{"DecimalComma", kGeneral + "2 2 1\n1 1 1,5\n",
                "W.mtx:3: value: expected a number, found '1,5'"},
        Refusal{"NaN", kGeneral + "2 2 1\n1 1 nan\n",
                "W.mtx:3: value: expected a finite number in the range of double, found 'nan'"},
        Refusal{"Infinity", kGeneral + "2 2 1\n1 1 -inf\n",
                "W.mtx:3: value: expected a finite number in the range of double, found '-inf'"},
        Refusal{"ValueOverflows", kGeneral + "2 2 1\n1 1 1e400\n",
                "W.mtx:3: value: expected a finite number in the range of double, found '1e400'"},
        Refusal{"IndexTooLarge", kGeneral + "2 2 1\n3 1 1\n",
                "W.mtx:3: row index: expected an integer from 1 to 2, found '3'"},
        Refusal{"IndexZero", kGeneral + "2 2 1\n1 0 1\n",
                "W.mtx:3: column index: expected an integer from 1 to 2, found '0'"},
        Refusal{"FourthNumber", kGeneral + "2 2 1\n1 1 1 0\n",
                "W.mtx:3: expected the end of the line after the value, found '0'"},
        Refusal{"Repeated", kGeneral + "2 2 3\n2 1 1\n1 1 1\n2 1 1\n",
                "W.mtx:5: entry (2, 1) was given before, in line 3"},
        Refusal{"UpperTriangle", kSymmetric + "2 2 1\n1 2 1\n",
                "W.mtx:3: entry (1, 2) lies above the diagonal: a symmetric file stores the lower "
                "triangle only"},
        Refusal{"BinaryRubbish", kGeneral + kRubbishEntry,
                "W.mtx:3: value: expected a number, found '\?\?\?'"},
        Refusal{"LongWordIsCut", kGeneral + "2 2 1\n1 1 " + kLongWord + "\n",
                "W.mtx:3: value: expected a number, found '" + kCutWord + "...'"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(MatrixMarket, RefusesBadArraysNamingLineAndExpectation) {
  EXPECT_EQ(array_error(kArray + "2 1\n1\n"),
            "q.mtx:3: the size line declares 2 values, the file ends after 1");
  EXPECT_EQ(array_error(kArray + "2 1\n1\nNaN\n"),
            "q.mtx:4: value: expected a finite number in the range of double, found 'NaN'");
  EXPECT_EQ(array_error(kArray + "1 1\n1 2\n"),
            "q.mtx:3: expected the end of the line after the value, found '2'");
  EXPECT_EQ(array_error(kArray + "1 1\n1\n2\n"),
            "q.mtx:4: expected the end of the file after the 1 values that the size line declares, "
            "found '2'");
  EXPECT_EQ(array_error(kSymmetric + "1 1 1\n1 1 1\n"),
            "q.mtx:1: MatrixMarket header: expected 'array', found 'coordinate'");
  EXPECT_EQ(error_of("q.mtx", kArray + "1 2\n1\n2\n", read_vector),
            "q.mtx: expected one column, found 2");
}

TEST(MatrixMarket, NamesAMissingFileAndAFolder) {
  const TemporaryFolder folder;
  try {
    (void)read_array(folder.path() / "q.mtx");
    FAIL() << "read a file that does not exist";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), (folder.path() / "q.mtx").string() + ": no such file");
  }
  try {
    (void)read_array(folder.path());
    FAIL() << "read a folder";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), folder.path().string() + ": not a regular file");
  }
}

/// A few bytes that declare 1e9 x 1e9 must not make the reader touch memory in proportion.
TEST(MatrixMarket, HugeDeclaredSizesCostNoMemory) {
  rusage before{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_EQ(coordinate_error(kGeneral + "1000000000 1000000000 5\n1 1 1\n"),
            "W.mtx:3: the size line declares 5 entries, the file ends after 1");
  EXPECT_EQ(coordinate_error(kGeneral + "1000000000 1000000000 2147483647\n1 1 1\n"),
            "W.mtx:3: the size line declares 2147483647 entries, the file ends after 1");
  EXPECT_EQ(array_error(kArray + "2147483647 2147483647\n1\n"),
            "q.mtx:3: the size line declares 4611686014132420609 values, the file ends after 1");
  const CoordinateMatrix honest = read_coordinates(kGeneral + "1000000000 1000000000 1\n1 1 1\n");
  EXPECT_EQ(honest.columns, 1000000000);
  rusage after{};
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024) << "kilobytes";
}

TEST(MatrixMarket, WrittenTextReadsBackToTheSameBits) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  Matrix dense = Matrix::NullaryExpr(9, 9, [&] {
    return random() % 3 == 0 ? 0.0 : std::pow(10.0, exponent(random)) * (random() % 2 ? 1 : -1);
  });
  dense(0, 0) = std::numeric_limits<double>::min();
  dense(1, 1) = std::numeric_limits<double>::max();
  dense(2, 2) = 0.1;
  const Matrix symmetric = dense.selfadjointView<Eigen::Lower>();
  for (const Matrix& matrix : {dense, symmetric}) {
    const std::string text = matrix_market_text(SparseMatrix(matrix.sparseView(1.0, 0.0)));
    EXPECT_EQ(text.find("symmetric") != std::string::npos, matrix == symmetric);
    EXPECT_EQ(Matrix(to_sparse(read_coordinates(text))), matrix);
  }
  const Vector column = dense.col(4);
  EXPECT_EQ(read_values(matrix_market_text(column)), column);
}

}  // namespace
}  // namespace signorini::lcp

#include "tests/adversary/picture_bombs.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string_view>
#include <utility>

#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

constexpr std::uint32_t kHuge = 32'000;

std::string Encoded(const cv::Mat& image, const std::string& extension, const std::vector<int>& how = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, how);
  return {bytes.begin(), bytes.end()};
}

std::string Big(std::uint32_t value, unsigned bytes = 4) {
  std::string text;
  for (unsigned i = bytes; i-- > 0;) text += static_cast<char>(value >> (8U * i));
  return text;
}

std::string Little(std::uint32_t value, unsigned bytes = 4) {
  const std::string big = Big(value, bytes);
  return {big.rbegin(), big.rend()};
}

std::uint32_t Crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? 0xEDB88320U ^ (crc >> 1U) : crc >> 1U;
  }
  return ~crc;
}

std::string Chunk(const std::string& type, const std::string& content) {
  return Big(static_cast<std::uint32_t>(content.size())) + type + content + Big(Crc32(type + content));
}

std::string Png(std::uint32_t width_px, std::uint32_t height_px, const std::string& chunks) {
  return "\x89PNG\r\n\x1a\n" +
         Chunk("IHDR", Big(width_px) + Big(height_px) + std::string("\x08\x02\0\0\0", 5)) + chunks +
         Chunk("IEND", "");
}

// 36 MB of zeros as zlib packs them.
std::string PackedZeros() {
  const std::string png = Encoded(cv::Mat::zeros(6000, 6000, CV_8UC1), ".png");
  std::string packed;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length * 256 + static_cast<unsigned char>(png[at + i]);
    if (png.compare(at + 4, 4, "IDAT") == 0) packed += png.substr(at + 8, length);
    at += 12 + length;
  }
  return packed;
}

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

struct Entry {
  std::uint32_t tag, type, value;
};

// Little-endian, one directory whose `next` is that; then some bytes of picture.
std::string Tiff(const std::vector<Entry>& entries, std::uint32_t next = 0) {
  constexpr std::uint32_t kDirectoryAt = 8;
  std::string bytes = std::string("II\x2a\0", 4) + Little(kDirectoryAt) +
                      Little(static_cast<std::uint32_t>(entries.size()), 2);
  for (const Entry& entry : entries)
    bytes += Little(entry.tag, 2) + Little(entry.type, 2) + Little(1) + Little(entry.value);
  return bytes + Little(next) + std::string(20'000, '\x33');
}

std::vector<Entry> TiffOf(std::uint32_t width_px, std::uint32_t height_px, const std::vector<Entry>& other) {
  std::vector<Entry> entries{{256, 4, width_px}, {257, 4, height_px}, {258, 3, 8}, {259, 3, 1}, {262, 3, 1}};
  entries.insert(entries.end(), other.begin(), other.end());
  return entries;
}

std::string JpegClaiming(std::string jpeg, std::uint32_t width_px, std::uint32_t height_px) {
  const std::size_t baseline = jpeg.find("\xff\xc0"), progressive = jpeg.find("\xff\xc2");
  return jpeg.replace((baseline < progressive ? baseline : progressive) + 5, 4,
                      Big(height_px, 2) + Big(width_px, 2));
}

void AddJpegs(const cv::Mat& picture, std::vector<Bomb>* bombs) {
  const std::string jpeg = Encoded(picture, ".jpg");
  std::string huge = JpegClaiming(jpeg, kHuge, kHuge);
  bombs->push_back({"claims.jpg", huge.insert(huge.size() - 2, 48'000, '\x11')});
  const std::string progressive = Encoded(picture, ".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  bombs->push_back({"claims_progressive.jpg", JpegClaiming(progressive, 65'535, 65'535)});
  // Its last scan again and again: each goes over all of the picture.
  const std::size_t scan = progressive.rfind("\xff\xda");
  const std::string last = progressive.substr(scan, progressive.size() - 2 - scan);
  bombs->push_back({"scans.jpg", progressive.substr(0, scan) + Repeated(last, 20'000) + "\xff\xd9"});
}

void AddPngs(const cv::Mat& picture, std::vector<Bomb>* bombs) {
  const auto width = static_cast<std::uint32_t>(picture.cols),
             height = static_cast<std::uint32_t>(picture.rows);
  const std::string zeros = PackedZeros(), pixels = Chunk("IDAT", zeros);
  bombs->push_back({"claims.png", Png(kHuge, kHuge, pixels)});
  bombs->push_back({"claims_all.png", Png(0x7FFFFFFFU, 0x7FFFFFFFU, pixels)});
  bombs->push_back({"pixels.png", Png(width, height, pixels)});
  bombs->push_back({"text.png", Png(width, height,
                                    Repeated(Chunk("zTXt", std::string("a\0\0", 3) + zeros), 30) + pixels)});
  bombs->push_back(
      {"profile.png", Png(width, height, Chunk("iCCP", std::string("a\0\0", 3) + zeros) + pixels)});
  bombs->push_back(
      {"chunks.png", Png(width, height, Repeated(Chunk("tEXt", std::string("a\0b", 3)), 200'000))});
}

void AddTiffs(const cv::Mat& picture, std::vector<Bomb>* bombs) {
  const auto width = static_cast<std::uint32_t>(picture.cols),
             height = static_cast<std::uint32_t>(picture.rows);
  const std::vector<Entry> strips{{273, 4, 400}, {277, 3, 1}, {278, 4, height}, {279, 4, 0xFFFFFFF0U}};
  bombs->push_back({"claims.tiff", Tiff(TiffOf(kHuge, kHuge, strips))});
  bombs->push_back({"strips.tiff", Tiff(TiffOf(width, height, strips))});
  bombs->push_back(
      {"rows.tiff", Tiff(TiffOf(width, height, {{273, 4, 400}, {278, 4, 0x7FFFFFFFU}, {279, 4, 9}}))});
  const std::vector<Entry> tiles{
      {277, 3, 1}, {322, 4, 1U << 20U}, {323, 4, 1U << 20U}, {324, 4, 400}, {325, 4, 900}};
  bombs->push_back({"tiles.tiff", Tiff(TiffOf(width, height, tiles))});
  bombs->push_back(
      {"samples.tiff", Tiff(TiffOf(width, height, {{273, 4, 400}, {277, 3, 65'535}, {279, 4, 9}}))});
  bombs->push_back({"loop.tiff", Tiff(TiffOf(width, height, strips), 8)});
}

void AddPlain(const cv::Mat& picture, std::vector<Bomb>* bombs) {
  std::string bmp = Encoded(picture, ".bmp");
  bombs->push_back(
      {"claims.bmp", std::string(bmp).replace(18, 8, Little(0x7FFFFFFFU) + Little(0x7FFFFFFFU))});
  bombs->push_back({"least.bmp", std::string(bmp).replace(18, 8, Little(0x80000000U) + Little(0x80000000U))});
  bombs->push_back({"place.bmp", std::string(bmp).replace(10, 4, Little(0x7FFFFFF0U))});
  bombs->push_back({"claims.ppm", "P6 32000 32000 255\n" + std::string(1000, '\x20')});
  bombs->push_back({"number.pgm", "P5 99999999999999999999 99999999999999999999 255\n"});
  bombs->push_back({"comment.pgm", "P5 #" + std::string(5'000'000, 'c')});
}

void AddVideos(const cv::Mat& picture, std::vector<Bomb>* bombs) {
  const test_support::TemporaryFolder folder;
  {
    cv::VideoWriter writer((folder / "v.avi").string(), cv::CAP_OPENCV_MJPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 30.0, picture.size());
    for (int i = 0; i < 10; ++i) writer.write(picture);
  }
  const std::string video = test_support::ReadText(folder / "v.avi");
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string changed = video;
    for (std::size_t at = 0; (at = changed.find(what, at)) != std::string::npos; at += by.size())
      changed.replace(at, what.size(), by);
    return changed;
  };
  const std::string size =
      Little(static_cast<std::uint32_t>(picture.cols)) + Little(static_cast<std::uint32_t>(picture.rows));
  const std::string size_in_frame =
      Big(static_cast<std::uint32_t>(picture.rows), 2) + Big(static_cast<std::uint32_t>(picture.cols), 2);
  bombs->push_back({"claims.avi", replaced(size, Little(kHuge) + Little(kHuge))});
  bombs->push_back({"frames.avi", replaced(size_in_frame, Big(kHuge, 2) + Big(kHuge, 2))});
  bombs->push_back({"all.avi", [&] {
                      std::string both = replaced(size, Little(kHuge) + Little(kHuge));
                      const std::size_t at = both.find(size_in_frame);
                      return both.replace(at, 4, Big(kHuge, 2) + Big(kHuge, 2));
                    }()});
  bombs->push_back({"zeros.avi", std::string("RIFF\xf0\xff\xff\x7f"
                                             "AVI ",
                                             12) +
                                     std::string(4'000'000, '\0')});
  bombs->push_back(
      {"list.avi",
       "#EXTM3U\n#EXTINF:10,\n/dev/zero\n#EXTINF:10,\nhttp://127.0.0.1:1/x.ts\n#EXT-X-ENDLIST\n"});
}

}  // namespace

std::vector<Bomb> MakeBombs(int width_px, int height_px) {
  const cv::Mat picture(height_px, width_px, CV_8UC3, cv::Scalar(40, 80, 120));
  std::vector<Bomb> bombs;
  AddJpegs(picture, &bombs);
  AddPngs(picture, &bombs);
  AddTiffs(picture, &bombs);
  AddPlain(picture, &bombs);
  AddVideos(picture, &bombs);
  return bombs;
}

}  // namespace elbowroom::adversary

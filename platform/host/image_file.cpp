// SPDX-License-Identifier: Apache-2.0
// PNG by libpng's simplified interface, JPEG by libjpeg. Both decode from memory, so that a test (or a fuzzer) can hand
// over any bytes.
#include "platform/host/image_file.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

#include <jpeglib.h>
#include <png.h>

#include "platform/host/host_error.h"
#include "platform/host/input_file.h"

namespace touchline::host {
namespace {

[[noreturn]] void damaged(const std::string& name, const char* kind, const std::string& why) {
  throw HostError(name + ": this " + kind + " cannot be read: " + why + "; copy or export the image again");
}

void check_size(const std::string& name, long width, long height) {
  if (width < 1 || height < 1 || width > max_frame_width || height > max_frame_height) {
    throw HostError(name + ": the image is " + std::to_string(width) + "x" + std::to_string(height) +
                    ", the largest supported is " + std::to_string(max_frame_width) + "x" +
                    std::to_string(max_frame_height) + "; scale it down (and focal_px, cx, cy with it)");
  }
}

RgbImage decode_png(std::span<const std::uint8_t> file, const std::string& name) {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, file.data(), file.size()) == 0) damaged(name, "PNG", png.message);
  png.format = PNG_FORMAT_RGB;
  RgbImage image;
  try {
    check_size(name, static_cast<long>(png.width), static_cast<long>(png.height));
    image = RgbImage(static_cast<int>(png.width), static_cast<int>(png.height));
  } catch (...) {
    png_image_free(&png);
    throw;
  }
  const png_color black = {0, 0, 0};
  if (png_image_finish_read(&png, &black, image.rgb.data(), 0, nullptr) == 0) damaged(name, "PNG", png.message);
  return image;
}

/// libjpeg reports by calling back: an error must not return, so it jumps; a warning (data missing or corrupt) is
/// kept and treated as an error too, because half a picture would give a wrong pose in silence.
struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf jump;
  char text[JMSG_LENGTH_MAX];
};

void jpeg_fail(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->text);
  std::longjmp(errors->jump, 1);
}
void jpeg_message(j_common_ptr info, int level) {
  if (level < 0) jpeg_fail(info);
}

/// Only C types live in here: longjmp runs no destructor. False: the reason is in errors.text.
bool decode_jpeg_rows(std::span<const std::uint8_t> file, JpegErrors& errors, RgbImage& image, bool& size_ok) {
  jpeg_decompress_struct info;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = jpeg_fail;
  errors.base.emit_message = jpeg_message;
  jpeg_create_decompress(&info);
  if (setjmp(errors.jump) != 0) {  // NOLINT: the only way that libjpeg offers
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_mem_src(&info, file.data(), static_cast<unsigned long>(file.size()));
  (void)jpeg_read_header(&info, TRUE);
  image.width = static_cast<int>(info.image_width);
  image.height = static_cast<int>(info.image_height);
  size_ok = image.width <= max_frame_width && image.height <= max_frame_height;
  if (size_ok) {
    image.rgb.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3U);
    info.out_color_space = JCS_RGB;
    (void)jpeg_start_decompress(&info);
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = image.at(0, static_cast<int>(info.output_scanline));
      (void)jpeg_read_scanlines(&info, &row, 1);
    }
    (void)jpeg_finish_decompress(&info);
  }
  jpeg_destroy_decompress(&info);
  return true;
}

/// Likewise: no destructor in here. `out` is freed by the caller.
bool encode_jpeg(const RgbImage& image, int quality, JpegErrors& errors, unsigned char*& out, unsigned long& size) {
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = jpeg_fail;
  errors.base.emit_message = jpeg_message;
  jpeg_create_compress(&info);
  if (setjmp(errors.jump) != 0) {  // NOLINT: the only way that libjpeg offers
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_mem_dest(&info, &out, &size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): libjpeg's type; it only reads
    JSAMPROW row = const_cast<std::uint8_t*>(image.at(0, static_cast<int>(info.next_scanline)));
    (void)jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

RgbImage decode_jpeg(std::span<const std::uint8_t> file, const std::string& name) {
  JpegErrors errors{};
  RgbImage image;
  bool size_ok = true;
  if (!decode_jpeg_rows(file, errors, image, size_ok)) damaged(name, "JPEG", errors.text);
  if (!size_ok) check_size(name, image.width, image.height);
  return image;
}

constexpr std::string_view png_signature = "\x89PNG";
constexpr std::string_view jpeg_signature = "\xFF\xD8\xFF";
/// The largest picture without compression, 16 bits a sample, eight times over.
constexpr std::size_t most_image_bytes = std::size_t{8} * max_frame_width * max_frame_height * 6;

void check_signature(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw HostError(name + ": the file is empty; give a PNG or JPEG image");
  if (bytes.starts_with(png_signature) || bytes.starts_with(jpeg_signature)) return;
  throw HostError(name + ": neither a PNG nor a JPEG file; convert it to one of the two");
}

}  // namespace

RgbImage decode_image(std::span<const std::uint8_t> file, const std::string& name) {
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  check_signature(bytes, name);
  return bytes.starts_with(png_signature) ? decode_png(file, name) : decode_jpeg(file, name);
}

RgbImage read_image(const std::filesystem::path& path, const std::string& remedy) {
  InputFile kind{"image", remedy, most_image_bytes};
  kind.first_bytes = [&path](std::string_view bytes) { check_signature(bytes, path.string()); };
  const std::string bytes = read_whole_file(path, kind);
  return decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path.string());
}

void write_png(const std::filesystem::path& path, const RgbImage& image) {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png.flags = PNG_IMAGE_FLAG_FAST;
  if (png_image_write_to_file(&png, path.string().c_str(), 0, image.rgb.data(), 0, nullptr) == 0) {
    throw HostError(path.string() + ": cannot be written: " + png.message + "; check the folder and the space left");
  }
}

void write_jpeg(const std::filesystem::path& path, const RgbImage& image, int quality) {
  JpegErrors errors{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool encoded = encode_jpeg(image, quality, errors, bytes, size);
  bool written = false;
  if (encoded) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    written = out.flush().good();
  }
  std::free(bytes);  // libjpeg allocated it by malloc
  if (!encoded) throw HostError(path.string() + ": cannot be encoded as JPEG: " + errors.text);
  if (!written) throw HostError(path.string() + ": cannot be written; check the folder and the space left");
}

}  // namespace touchline::host

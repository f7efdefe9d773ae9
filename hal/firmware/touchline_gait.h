/* SPDX-License-Identifier: Apache-2.0 */
/* The gait frame, version 1: the whole sending side for a walking controller, in C99 without dependencies.
 *
 * Copy this one file into the firmware. Fill a `touchline_gait`, call touchline_gait_encode() once a control cycle and
 * write the bytes it returns to the serial port:
 *
 *   static touchline_gait gait;  // zeros; gait.boot_id is set once, after the start
 *   uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
 *   gait.flags = TOUCHLINE_GAIT_WALKING | TOUCHLINE_GAIT_HAS_CAMERA, gait.time_us = micros(), ++gait.sequence;
 *   gait.x_m = x, gait.y_m = y, gait.theta_rad = theta, gait.camera_height_m = height, gait.camera_pitch_rad = pitch;
 *   uart_write(frame, touchline_gait_encode(&gait, frame));
 *
 * The line: 8 data bits, no parity, 1 stop bit, no flow control, one direction; the same rate as `gait.baud` of
 * robot.toml, 115200 by default (a USB serial port ignores the rate). 44 bytes a frame: 100 frames a second take 38 %
 * of 115200 baud. How often: 50 to 200 frames a second, in even steps. Between frames the path is interpolated, after
 * the newest it is unknown; a head that sways wants 50. A pause longer than `gait.stale_ms` (300 ms) is silence, and
 * below 4 frames a second there is nothing else.
 *
 * What the receiver does with it: the odometry moves the pose; camera attitude or head joints take the place of those
 * of [mount]; fallen and lifted give the pose up and start from nothing when they end. Walking, standing and the
 * support foot are checked and handed to programs that read the link (hal/gait_link.h); touchline itself does not use
 * them yet.
 *
 *   frame on the wire = COBS(payload, CRC-32 of the payload) followed by one zero byte
 *   COBS: Cheshire and Baker, "Consistent Overhead Byte Stuffing", 1999; no zero byte is left inside a frame
 *   CRC-32: IEEE 802.3, reflected, polynomial EDB88320, start and final exclusive-or FFFFFFFF, sent low byte first
 *
 * Payload, little-endian, signed numbers in two's complement:
 *   byte  type  meaning
 *    0    u8    version of the format: 1
 *    1    u8    flags: bit 0 walking, 1 standing, 2 fallen, 3 lifted, 4 camera attitude valid, 5 head valid; rest 0
 *    2    u8    support foot: 0 unknown, 1 left, 2 right, 3 both
 *    3    u8    0
 *    4    u32   boot id: another number after each start of the controller (a counter in flash, or random)
 *    8    u32   sequence: grows by one with each frame, wraps
 *   12    u32   time of the sample, microseconds of the controller's clock, wraps
 *   16    i32   odometry x: 0.1 mm, where the robot is now in its own frame at boot, x forward at boot
 *   20    i32   odometry y: 0.1 mm, left at boot
 *   24    i32   odometry theta: 1e-5 rad, counter-clockwise, wrapped or summed
 *   28    u16   camera height above the carpet: 0.1 mm          (valid with flag 4)
 *   30    i16   camera pitch: 1e-4 rad, positive looks down     (valid with flag 4)
 *   32    i16   camera roll: 1e-4 rad, positive lowers its right (valid with flag 4)
 *   34    i16   head pan: 1e-4 rad, positive looks left         (valid with flag 5)
 *   36    i16   head tilt: 1e-4 rad, positive looks down        (valid with flag 5)
 *   38    u32   CRC-32 of bytes 0 to 37
 *
 * The odometry is a sum since boot and never a step: then a lost frame loses no step. Values out of range, and NaN, are
 * sent as the nearest number that fits (NaN as 0).
 */
#ifndef TOUCHLINE_GAIT_H
#define TOUCHLINE_GAIT_H

#include <stdint.h>

/* C++ firmware may forbid the casts of C. */
#ifdef __cplusplus
#define TOUCHLINE_GAIT_AS(type, value) static_cast<type>(value)
#else
#define TOUCHLINE_GAIT_AS(type, value) ((type)(value))
#endif

#define TOUCHLINE_GAIT_VERSION 1u
#define TOUCHLINE_GAIT_PAYLOAD_BYTES 38u
#define TOUCHLINE_GAIT_FRAME_BYTES 44u /* COBS code byte, payload, CRC-32, zero */

#define TOUCHLINE_GAIT_WALKING 0x01u
#define TOUCHLINE_GAIT_STANDING 0x02u
#define TOUCHLINE_GAIT_FALLEN 0x04u
#define TOUCHLINE_GAIT_LIFTED 0x08u
#define TOUCHLINE_GAIT_HAS_CAMERA 0x10u
#define TOUCHLINE_GAIT_HAS_HEAD 0x20u

#define TOUCHLINE_GAIT_FOOT_UNKNOWN 0u
#define TOUCHLINE_GAIT_FOOT_LEFT 1u
#define TOUCHLINE_GAIT_FOOT_RIGHT 2u
#define TOUCHLINE_GAIT_FOOT_BOTH 3u

typedef struct touchline_gait {
  uint8_t flags;        /* TOUCHLINE_GAIT_WALKING | ... */
  uint8_t support_foot; /* TOUCHLINE_GAIT_FOOT_... */
  uint32_t boot_id;
  uint32_t sequence;
  uint32_t time_us;
  float x_m;
  float y_m;
  float theta_rad;
  float camera_height_m;
  float camera_pitch_rad;
  float camera_roll_rad;
  float head_pan_rad;
  float head_tilt_rad;
} touchline_gait;

static inline uint8_t* touchline_gait_put(uint8_t* at, uint32_t value, int bytes) {
  int i;
  for (i = 0; i < bytes; ++i) *at++ = TOUCHLINE_GAIT_AS(uint8_t, value >> (8 * i));
  return at;
}

/* Rounded to the nearest whole number and kept within [low, high]; NaN gives 0. */
static inline int32_t touchline_gait_round(float scaled, int32_t low, int32_t high) {
  if (scaled >= TOUCHLINE_GAIT_AS(float, high)) return high;
  if (scaled <= TOUCHLINE_GAIT_AS(float, low)) return low;
  if (!(scaled == scaled)) return 0;
  return TOUCHLINE_GAIT_AS(int32_t, scaled < 0.0f ? scaled - 0.5f : scaled + 0.5f);
}

static inline uint8_t* touchline_gait_put_number(uint8_t* at, float scaled, int32_t low, int32_t high, int bytes) {
  return touchline_gait_put(at, TOUCHLINE_GAIT_AS(uint32_t, touchline_gait_round(scaled, low, high)), bytes);
}

static inline uint32_t touchline_gait_crc32(const uint8_t* bytes, uint32_t size) {
  uint32_t crc = 0xFFFFFFFFu;
  uint32_t i;
  for (i = 0; i < size; ++i) {
    int bit;
    crc ^= bytes[i];
    for (bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
  }
  return crc ^ 0xFFFFFFFFu;
}

/* Writes one frame and returns its length, always TOUCHLINE_GAIT_FRAME_BYTES. */
static inline uint32_t touchline_gait_encode(const touchline_gait* gait, uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES]) {
  const float wide[3] = {gait->x_m * 1e4f, gait->y_m * 1e4f, gait->theta_rad * 1e5f};
  const float narrow[4] = {gait->camera_pitch_rad * 1e4f, gait->camera_roll_rad * 1e4f, gait->head_pan_rad * 1e4f,
                           gait->head_tilt_rad * 1e4f};
  uint8_t* const payload = frame + 1; /* stuffed in place: the code bytes take the place of the zeros */
  uint8_t* at = payload;
  uint8_t* code = frame;
  int i;
  *at++ = TOUCHLINE_GAIT_AS(uint8_t, TOUCHLINE_GAIT_VERSION);
  *at++ = TOUCHLINE_GAIT_AS(uint8_t, gait->flags & 0x3Fu);
  *at++ = TOUCHLINE_GAIT_AS(uint8_t, gait->support_foot & 0x03u);
  *at++ = 0;
  at = touchline_gait_put(at, gait->boot_id, 4);
  at = touchline_gait_put(at, gait->sequence, 4);
  at = touchline_gait_put(at, gait->time_us, 4);
  for (i = 0; i < 3; ++i) at = touchline_gait_put_number(at, wide[i], INT32_MIN, INT32_MAX, 4);
  at = touchline_gait_put_number(at, gait->camera_height_m * 1e4f, 0, 65535, 2);
  for (i = 0; i < 4; ++i) at = touchline_gait_put_number(at, narrow[i], -32768, 32767, 2);
  at = touchline_gait_put(at, touchline_gait_crc32(payload, TOUCHLINE_GAIT_PAYLOAD_BYTES), 4);
  *at = 0;
  for (at = payload; at < frame + TOUCHLINE_GAIT_FRAME_BYTES; ++at) {
    if (*at == 0) {
      *code = TOUCHLINE_GAIT_AS(uint8_t, at - code);
      code = at;
    }
  }
  return TOUCHLINE_GAIT_FRAME_BYTES; /* the last zero stays: it ends the frame */
}

#endif

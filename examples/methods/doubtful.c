/* SPDX-License-Identifier: BSD-3-Clause
 * Returns the unchanged gyro readings, with a large variance for clipped readings: doubtful READINGS.csv RATES.csv.
 * Compile with cc -O2 -o doubtful doubtful.c -lm. doubtful.yaml describes the method. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kLineMax = 4096, kColumnsMax = 64 };
static const double kAtRail = 0.98;        /* a reading is clipped above this share of the axis's largest reading */
static const double kFree_rad_s = 0.01;    /* standard deviation of an unclipped reading */
static const double kClipped_rad_s = 5.0;  /* standard deviation of a clipped reading */

/* Finds the column of each name in the header. */
static int columns_of(char* header, const char* const* names, int count, int* columns) {
  int column = 0, found = 0;
  for (char* word = strtok(header, ",\r\n"); word != NULL; word = strtok(NULL, ",\r\n"), ++column)
    for (int k = 0; k < count; ++k)
      if (strcmp(word, names[k]) == 0) columns[k] = column, ++found;
  return found == count;
}

/* Reads the numbers of a line, by column. */
static int cells_of(char* line, double* cells) {
  int count = 0;
  for (char* word = strtok(line, ",\r\n"); word != NULL && count < kColumnsMax; word = strtok(NULL, ",\r\n"))
    cells[count++] = strtod(word, NULL);
  return count;
}

struct sample {
  long long time_ns;
  double w_rad_s[3];
};

static struct sample* read_samples(FILE* file, size_t* count) {
  static const char* const names[] = {"stamp_s", "stamp_ns", "wx_rad_s", "wy_rad_s", "wz_rad_s"};
  char line[kLineMax];
  int at[5];
  double cells[kColumnsMax];
  size_t room = 1024;
  struct sample* samples = malloc(room * sizeof *samples);
  *count = 0;
  if (samples == NULL || fgets(line, sizeof line, file) == NULL || !columns_of(line, names, 5, at)) return NULL;
  while (fgets(line, sizeof line, file) != NULL) {
    if (*count == room) samples = realloc(samples, (room *= 2) * sizeof *samples);
    const int found = cells_of(line, cells);
    if (samples == NULL || found <= at[4]) return NULL;
    struct sample* now = &samples[(*count)++];
    now->time_ns = (long long)cells[at[0]] * 1000000000 + (long long)cells[at[1]];
    for (int k = 0; k < 3; ++k) now->w_rad_s[k] = cells[at[2 + k]];
  }
  return samples;
}

int main(int argc, char** argv) {
  FILE* in = argc == 3 ? fopen(argv[1], "r") : NULL;
  FILE* out = argc == 3 ? fopen(argv[2], "w") : NULL;
  size_t count = 0;
  struct sample* samples = in != NULL && out != NULL ? read_samples(in, &count) : NULL;
  if (samples == NULL) {
    fprintf(stderr, "usage: doubtful READINGS.csv RATES.csv, with columns stamp_s, stamp_ns, wx_rad_s, wy_rad_s, wz_rad_s\n");
    return 1;
  }
  double largest[3] = {0, 0, 0};
  for (size_t i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) largest[k] = fmax(largest[k], fabs(samples[i].w_rad_s[k]));
  fprintf(out, "time_ns,wx_rad_s,wy_rad_s,wz_rad_s,cxx,cxy,cxz,cyy,cyz,czz\n");
  for (size_t i = 0; i < count; ++i) {
    double variance[3];
    for (int k = 0; k < 3; ++k) {
      const double sigma = fabs(samples[i].w_rad_s[k]) >= kAtRail * largest[k] ? kClipped_rad_s : kFree_rad_s;
      variance[k] = sigma * sigma;
    }
    fprintf(out, "%lld,%.17g,%.17g,%.17g,%g,0,0,%g,0,%g\n", samples[i].time_ns, samples[i].w_rad_s[0],
            samples[i].w_rad_s[1], samples[i].w_rad_s[2], variance[0], variance[1], variance[2]);
  }
  free(samples);
  return fclose(in) == 0 && fclose(out) == 0 ? 0 : 1;
}

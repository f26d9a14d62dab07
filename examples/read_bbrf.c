/* Prints the values of a measurement of a bbrf file, with their unit: read_bbrf FILE.bbrf MEASUREMENT
 * h5cc read_bbrf.c -o read_bbrf, or cc read_bbrf.c $(pkg-config --cflags --libs hdf5) -o read_bbrf */
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>

static void *whole(hid_t group, const char *name, hid_t type, size_t size, hsize_t shape[2]) {
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT), space = H5Dget_space(dataset);
    shape[0] = shape[1] = 1;
    if (dataset < 0 || H5Sget_simple_extent_ndims(space) > 2) return NULL;
    H5Sget_simple_extent_dims(space, shape, NULL);
    void *values = malloc(size * (shape[0] * shape[1] + 1));
    if (values == NULL || H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) return NULL;
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    hid_t file = H5Fopen(arguments[1], H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t list = H5Gopen2(file, "measurement", H5P_DEFAULT);
    hid_t group = H5Gopen2(list, arguments[2], H5P_DEFAULT);
    if (group < 0) return 2;
    char unit[64] = "";
    hid_t attribute = H5Aopen_by_name(group, "value", "units", H5P_DEFAULT, H5P_DEFAULT);
    hid_t text = H5Tcopy(H5T_C_S1); /* fixed length, padded with NUL, UTF-8 */
    H5Tset_size(text, sizeof unit);
    H5Tset_cset(text, H5T_CSET_UTF8);
    H5Aread(attribute, text, unit);
    hsize_t shape[2], flag_shape[2];
    double *value = whole(group, "value", H5T_NATIVE_DOUBLE, sizeof *value, shape);
    unsigned short *flag = whole(group, "value_flag", H5T_NATIVE_USHORT, sizeof *flag, flag_shape);
    if (value == NULL || flag == NULL || shape[0] != flag_shape[0] || shape[1] != flag_shape[1]) return 1;
    printf("%s\n", unit);
    for (hsize_t row = 0; row < shape[0]; row++)
        for (hsize_t column = 0; column < shape[1]; column++)
            printf("%llu,%llu,%.17g,%u\n", (unsigned long long)row, (unsigned long long)column,
                   value[row * shape[1] + column], flag[row * shape[1] + column]);
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
// /dev/i2c-1 with one PCA9685 on it, for programs that think they talk to Linux's i2c-dev. Preload it.
//
//     cc -shared -fPIC -O2 -o i2cdev.so i2cdev.c
//     ZTELEOP_I2CDEV_FILE=chip LD_PRELOAD=$PWD/i2cdev.so python program.py
//
// The chip lies in that file, which zteleop/drivers/chip_file.py makes: 256 registers, then 16 bytes of
// faults to come. Everything else is written from the data sheet (rev. 4) and <linux/i2c-dev.h> alone, so
// that two models can be held against each other.
#define _GNU_SOURCE
#undef _FILE_OFFSET_BITS // would turn open into open64, which is defined here too
#undef _TIME_BITS
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { MODE1 = 0x00, MODE2 = 0x01, LED0_ON_L = 0x06, LED15_OFF_H = 0x45 };
enum { ALL_LED_ON_L = 0xFA, ALL_LED_OFF_H = 0xFD, PRE_SCALE = 0xFE, REGISTERS = 0x100 };
enum { RESTART = 0x80, EXTCLK = 0x40, AUTO_INCREMENT = 0x20, SLEEP = 0x10, FULL_OFF = 0x10 };
enum { DESCRIPTORS = 1024 };

struct faults { // little-endian, as every machine this is built for
    uint32_t nack, tear, hang;
    uint16_t after_bytes, ms, every, percent;
    uint32_t state;
    uint16_t slow_ms, spare;
};

struct chip {
    uint8_t registers[REGISTERS];
    struct faults faults;
};

struct fault {
    int error;
    unsigned data_bytes; // that still get through
    unsigned ms;
};
#define NO_FAULT ((struct fault){0, UINT_MAX, 0})

static struct chip *chip;
static uint8_t control; // the chip's control register: where the next byte goes to or comes from
static unsigned timeout_ms = 1000;
static struct {
    bool is_bus;
    uint8_t address;
} descriptors[DESCRIPTORS];

static const char *chip_file(void) { return getenv("ZTELEOP_I2CDEV_FILE"); }

static unsigned chip_address(void)
{
    const char *text = getenv("ZTELEOP_I2CDEV_ADDRESS");
    return text ? strtoul(text, NULL, 0) : 0x40;
}

// The registers, section 7.3

static bool pulses_run(const uint8_t *registers)
{
    for (int off_h = LED0_ON_L + 3; off_h <= LED15_OFF_H; off_h += 4)
        if (!(registers[off_h] & FULL_OFF))
            return true;
    return false;
}

static uint8_t new_mode1(const uint8_t *registers, uint8_t value)
{
    uint8_t before = registers[MODE1], restart = before & RESTART;
    if (value & SLEEP) {
        if (!(before & SLEEP) && pulses_run(registers))
            restart = RESTART;
    } else if (value & RESTART) {
        restart = 0; // writing 1 clears it
    }
    return (value & ~RESTART) | restart | (before & EXTCLK);
}

static void store_led(uint8_t *registers, int place, uint8_t value)
{
    bool is_high_byte = (place - LED0_ON_L) & 1;
    registers[place] = is_high_byte ? value & 0x1F : value;
    registers[MODE1] &= ~RESTART; // section 7.3.1.1: any PWM register and a STOP
}

static void store(uint8_t *registers, uint8_t place, uint8_t value)
{
    if (place == MODE1) {
        registers[MODE1] = new_mode1(registers, value);
    } else if (place == MODE2) {
        registers[MODE2] = value & 0x1F;
    } else if (place == PRE_SCALE) {
        if (registers[MODE1] & SLEEP)
            registers[PRE_SCALE] = value < 3 ? 3 : value;
    } else if (place >= ALL_LED_ON_L) {
        for (int led = LED0_ON_L; led <= LED15_OFF_H; led += 4)
            store_led(registers, led + place - ALL_LED_ON_L, value);
    } else if (place >= LED0_ON_L) {
        store_led(registers, place, value);
    } else {
        registers[place] = value & 0xFE; // SUBADR1..3, ALLCALLADR
    }
}

static bool acknowledges(uint8_t place)
{
    return place <= LED15_OFF_H || (place >= ALL_LED_ON_L && place <= PRE_SCALE);
}

static void advance(const uint8_t *registers)
{
    if (registers[MODE1] & AUTO_INCREMENT)
        control = control == LED15_OFF_H || control == PRE_SCALE ? 0 : control + 1;
}

// Between START and STOP

static int receive(uint8_t *registers, const struct i2c_msg *message, unsigned *data_bytes)
{
    if (message->len)
        control = message->buf[0];
    for (int i = 1; i < message->len; i++) {
        if (!*data_bytes || !acknowledges(control))
            return EREMOTEIO;
        --*data_bytes;
        store(registers, control, message->buf[i]);
        advance(registers);
    }
    return 0;
}

static int answer(const uint8_t *registers, const struct i2c_msg *message)
{
    for (int i = 0; i < message->len; i++) {
        if (!acknowledges(control))
            return EREMOTEIO;
        message->buf[i] = registers[control]; // nothing is ever stored in ALL_LED_*: they read 0
        advance(registers);
    }
    return 0;
}

static void latch(const uint8_t *registers)
{
    int first = 0, end = REGISTERS;
    while (first < end && chip->registers[first] == registers[first])
        first++;
    while (end > first && chip->registers[end - 1] == registers[end - 1])
        end--;
    memcpy(chip->registers + first, registers + first, end - first);
}

static struct fault count_down(struct faults *faults, unsigned written)
{
    if (faults->hang && faults->hang--)
        return (struct fault){ETIMEDOUT, 0, faults->ms < timeout_ms ? faults->ms : timeout_ms};
    if (faults->nack && faults->nack--)
        return (struct fault){EREMOTEIO, 0, 0};
    if (faults->tear && written > faults->after_bytes && faults->tear--)
        return (struct fault){EREMOTEIO, faults->after_bytes, 0};
    if (faults->every) {
        faults->state = (faults->state + 1) % faults->every;
        return faults->state ? NO_FAULT : (struct fault){EREMOTEIO, 0, 0};
    }
    if (faults->percent) {
        faults->state = faults->state * 1664525u + 1013904223u;
        return (faults->state >> 16) % 100 < faults->percent ? (struct fault){EREMOTEIO, 0, 0} : NO_FAULT;
    }
    return NO_FAULT;
}

static void wait_ms(unsigned ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000L}, NULL);
}

static struct fault meet_fault(unsigned written)
{
    static const struct faults none;
    if (!memcmp(&chip->faults, &none, sizeof none))
        return NO_FAULT;
    int file = open(chip_file(), O_RDWR | O_CLOEXEC);
    flock(file, LOCK_EX); // whoever clears faults must not find them again
    struct fault fault = count_down(&chip->faults, written);
    wait_ms(chip->faults.slow_ms); // with the lock: a bus does one transfer at a time
    close(file);
    wait_ms(fault.ms);
    return fault;
}

static int transfer(struct i2c_msg *messages, unsigned count)
{
    uint8_t registers[REGISTERS];
    unsigned written = 0;
    for (unsigned i = 0; i < count; i++)
        if (!(messages[i].flags & I2C_M_RD) && messages[i].len)
            written += messages[i].len - 1;
    if (messages[0].addr != chip_address())
        return EREMOTEIO;
    struct fault fault = meet_fault(written);
    if (fault.error && !fault.data_bytes)
        return fault.error;
    memcpy(registers, chip->registers, sizeof registers);
    int error = 0;
    for (unsigned i = 0; i < count && !error; i++) {
        if (messages[i].addr != chip_address())
            error = EREMOTEIO;
        else if (messages[i].flags & I2C_M_RD)
            error = answer(registers, &messages[i]);
        else
            error = receive(registers, &messages[i], &fault.data_bytes);
    }
    latch(registers); // also after an error: the master ends in a STOP
    return error;
}

// The kernel's side

static int smbus(uint8_t address, const struct i2c_smbus_ioctl_data *call)
{
    uint8_t sent[I2C_SMBUS_BLOCK_MAX + 1] = {call->command};
    bool reads = call->read_write == I2C_SMBUS_READ;
    struct i2c_msg alone = {address, reads ? I2C_M_RD : 0, 0, sent};
    uint8_t *data;
    unsigned length;
    switch (call->size) {
    case I2C_SMBUS_QUICK: return transfer(&alone, 1);
    case I2C_SMBUS_BYTE:
        alone.len = 1;
        if (reads)
            alone.buf = &call->data->byte;
        return transfer(&alone, 1);
    case I2C_SMBUS_BYTE_DATA: data = &call->data->byte, length = 1; break;
    case I2C_SMBUS_WORD_DATA: data = (uint8_t *)&call->data->word, length = 2; break;
    case I2C_SMBUS_I2C_BLOCK_DATA: data = call->data->block + 1, length = call->data->block[0]; break;
    default: return EOPNOTSUPP;
    }
    if (!length || length > I2C_SMBUS_BLOCK_MAX)
        return EINVAL;
    if (!reads)
        memcpy(sent + 1, data, length);
    struct i2c_msg messages[] = {
        {address, 0, reads ? 1 : length + 1, sent},
        {address, I2C_M_RD, length, data},
    };
    return transfer(messages, reads ? 2 : 1);
}

static int control_bus(int fd, unsigned long request, unsigned long argument)
{
    const struct i2c_rdwr_ioctl_data *combined = (struct i2c_rdwr_ioctl_data *)argument;
    switch (request) {
    case I2C_FUNCS:
        *(unsigned long *)argument = I2C_FUNC_I2C | I2C_FUNC_SMBUS_QUICK | I2C_FUNC_SMBUS_BYTE |
            I2C_FUNC_SMBUS_BYTE_DATA | I2C_FUNC_SMBUS_WORD_DATA | I2C_FUNC_SMBUS_I2C_BLOCK;
        return 0;
    case I2C_SLAVE:
    case I2C_SLAVE_FORCE:
        if (argument > 0x7F)
            return EINVAL;
        descriptors[fd].address = argument;
        return 0;
    case I2C_TIMEOUT:
        if (argument > INT_MAX / 10)
            return EINVAL;
        timeout_ms = argument * 10;
        return 0;
    case I2C_RETRIES: // after a lost arbitration, which one master cannot lose
    case I2C_PEC:     // not among the functions, as the chip knows no checksum
        return 0;
    case I2C_SMBUS: return smbus(descriptors[fd].address, (struct i2c_smbus_ioctl_data *)argument);
    case I2C_RDWR:
        if (!combined->nmsgs || combined->nmsgs > I2C_RDWR_IOCTL_MAX_MSGS)
            return EINVAL;
        return transfer(combined->msgs, combined->nmsgs);
    default: return ENOTTY;
    }
}

static bool attach_chip(void)
{
    struct stat found;
    int file = chip ? -1 : open(chip_file(), O_RDWR | O_CLOEXEC);
    if (file < 0)
        return chip;
    void *memory = MAP_FAILED;
    if (!fstat(file, &found) && found.st_size >= (off_t)sizeof *chip)
        memory = mmap(NULL, sizeof *chip, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    else
        errno = ENODEV;
    close(file);
    chip = memory == MAP_FAILED ? NULL : memory;
    return chip;
}

static int open_any(int folder, const char *path, int flags, mode_t mode)
{
    bool is_bus = path && !strcmp(path, "/dev/i2c-1") && chip_file();
    if (is_bus && !attach_chip())
        return -1;
    char own[PATH_MAX];
    if (path && chip_file() && strstr(path, "/zteleop-i2c-")) { // the lock of a chip that only we have
        snprintf(own, sizeof own, "%s.lock", chip_file());
        path = own;
    }
    int fd = syscall(SYS_openat, folder, is_bus ? "/dev/null" : path, flags, mode);
    if (is_bus && fd >= DESCRIPTORS) {
        syscall(SYS_close, fd);
        errno = EMFILE;
        return -1;
    }
    if (fd >= 0 && fd < DESCRIPTORS)
        descriptors[fd].is_bus = is_bus, descriptors[fd].address = 0;
    return fd;
}

// What the program calls

#define OPEN(name, folder, added, ...)                                                              \
    int name(__VA_ARGS__, int flags, ...)                                                           \
    {                                                                                               \
        va_list rest;                                                                               \
        va_start(rest, flags);                                                                      \
        mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;                     \
        va_end(rest);                                                                               \
        return open_any(folder, path, flags | (added), mode);                                       \
    }
OPEN(open, AT_FDCWD, 0, const char *path)
OPEN(open64, AT_FDCWD, O_LARGEFILE, const char *path)
OPEN(openat, folder, 0, int folder, const char *path)
OPEN(openat64, folder, O_LARGEFILE, int folder, const char *path)

// Where glibc's _FORTIFY_SOURCE sends an open without a mode, as in Debian's own Python
#define OPEN_2(name, folder, added, ...)                                                            \
    int name(__VA_ARGS__, int flags) { return open_any(folder, path, flags | (added), 0); }
OPEN_2(__open_2, AT_FDCWD, 0, const char *path)
OPEN_2(__open64_2, AT_FDCWD, O_LARGEFILE, const char *path)
OPEN_2(__openat_2, folder, 0, int folder, const char *path)
OPEN_2(__openat64_2, folder, O_LARGEFILE, int folder, const char *path)

int close(int fd)
{
    if (fd >= 0 && fd < DESCRIPTORS)
        descriptors[fd].is_bus = false;
    return syscall(SYS_close, fd);
}

#ifdef __GLIBC__
int ioctl(int fd, unsigned long request, ...)
#else
int ioctl(int fd, int request, ...)
#endif
{
    va_list rest;
    va_start(rest, request);
    unsigned long argument = va_arg(rest, unsigned long);
    va_end(rest);
    if (fd < 0 || fd >= DESCRIPTORS || !descriptors[fd].is_bus)
        return syscall(SYS_ioctl, fd, request, argument);
    int error = control_bus(fd, request, argument);
    if (!error)
        return request == I2C_RDWR ? (int)((struct i2c_rdwr_ioctl_data *)argument)->nmsgs : 0;
    errno = error;
    return -1;
}

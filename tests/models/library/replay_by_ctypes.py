"""replay_by_ctypes.py LIBRARY RECORDING FORCES.csv MODEL.json...: the forces that
`palpate replay` wrote, once more through the C interface. Python's own ctypes, nothing
else. Prints the rows that were compared; fails at the first bit that differs."""
import csv
import ctypes
import struct
import sys


class Sensor(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in (
        "encoder_step_m", "position_noise_m", "velocity_noise_m_per_s", "acceleration_noise_m_per_s2")] + [
        ("has_velocity", ctypes.c_int), ("has_acceleration", ctypes.c_int)]


def load(path):
    library = ctypes.CDLL(path)
    library.palpate_model_load.restype = ctypes.c_void_p
    library.palpate_model_load.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_size_t]
    library.palpate_model_name.restype = ctypes.c_char_p
    library.palpate_model_name.argtypes = [ctypes.c_void_p]
    library.palpate_model_free.argtypes = [ctypes.c_void_p]
    library.palpate_sensor_of_recording.argtypes = [
        ctypes.c_char_p, ctypes.POINTER(Sensor), ctypes.c_char_p, ctypes.c_size_t]
    library.palpate_stream_new_with_sensor.restype = ctypes.c_void_p
    library.palpate_stream_new_with_sensor.argtypes = [
        ctypes.c_void_p, ctypes.POINTER(Sensor), ctypes.c_char_p, ctypes.c_size_t]
    library.palpate_stream_force_with_motion.restype = ctypes.c_double
    library.palpate_stream_force_with_motion.argtypes = [ctypes.c_void_p] + [ctypes.c_double] * 4
    library.palpate_stream_free.argtypes = [ctypes.c_void_p]
    return library


def main(library_path, recording, forces, models):
    library = load(library_path)
    error = ctypes.create_string_buffer(1000)
    sensor = Sensor()
    if library.palpate_sensor_of_recording(recording.encode(), sensor, error, len(error)) != 0:
        sys.exit(error.value.decode())
    with open(recording, newline="") as file:
        motion = [[float(row.get(name) or 0.0) for name in (
            "time_s", "position_m", "velocity_m_per_s", "acceleration_m_per_s2")]
            for row in csv.DictReader(line for line in file if not line.startswith("#"))]
    with open(forces, newline="") as file:
        expected = list(csv.DictReader(file))
    if len(expected) != len(motion):
        sys.exit("the recording has %d rows, its forces %d" % (len(motion), len(expected)))
    compared = 0
    for path in models:
        model = library.palpate_model_load(path.encode(), error, len(error))
        if not model:
            sys.exit(error.value.decode())
        column = library.palpate_model_name(model).decode() + "_N"
        stream = library.palpate_stream_new_with_sensor(model, sensor, error, len(error))
        if not stream:
            sys.exit(error.value.decode())
        library.palpate_model_free(model)
        for number, (sample, row) in enumerate(zip(motion, expected)):
            force = library.palpate_stream_force_with_motion(stream, *sample)
            if struct.pack("d", force) != struct.pack("d", float(row[column])):
                sys.exit("%s row %d: %r N, replay %s N" % (column, number, force, row[column]))
            compared += 1
        library.palpate_stream_free(stream)
    print(compared)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:])

"""A Kepler ellipse by an emitted plugin, with the standard library of Python alone."""
import ctypes
import math
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_longlong, c_void_p

doubles, none = POINTER(c_double), None


class Report(ctypes.Structure):
    _fields_ = [
        ("status", c_int), ("steps_done", c_longlong), ("iterations", c_longlong),
        ("last_iterations", c_int), ("last_increment", c_double),
        ("energy_min", c_double), ("energy_min_lo", c_double),
        ("energy_max", c_double), ("energy_max_lo", c_double),
        ("energy_last", c_double), ("energy_last_lo", c_double)]


class Quantity(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("comment", c_char_p),
                ("is_array", c_int), ("first", c_int), ("count", c_int)]


def function(result, *arguments):
    return ctypes.CFUNCTYPE(result, *arguments)


class Plugin(ctypes.Structure):  # struct hamgen_plugin of plugin.h, version 5
    _fields_ = [
        ("version", c_int), ("degrees_of_freedom", c_int), ("parameter_count", c_int),
        ("invariant_count", c_int), ("scalar_digits", c_int),
        ("description", c_char_p), ("solver", c_char_p),
        ("create", function(c_void_p, doubles, doubles, c_double, c_double, doubles, doubles)),
        ("destroy", function(none, c_void_p)),
        ("advance", function(none, c_void_p, c_longlong, c_int, POINTER(Report))),
        ("get_state", function(none, c_void_p, doubles, doubles)),
        ("get_carry", function(none, c_void_p, doubles, doubles)),
        ("energy", function(c_double, doubles, doubles, doubles, doubles, doubles)),
        ("invariants", function(none, doubles, doubles, doubles, doubles, doubles, doubles)),
        ("gradient", function(none, doubles, doubles, doubles)),
        ("tangent", function(c_int, doubles, c_double, doubles, doubles, doubles)),
        ("save", function(c_longlong, c_void_p, c_void_p)),
        ("restore", function(c_int, c_void_p, c_void_p, c_longlong)),
        ("variable_list", POINTER(Quantity)), ("parameter_list", POINTER(Quantity)),
        ("invariant_list", POINTER(Quantity)),
        ("default_parameters", function(none, doubles, doubles)),
        ("get_time", function(c_double, c_void_p, doubles)),
        ("get_h", function(c_double, c_void_p, doubles)),
        ("get_parameters", function(none, c_void_p, doubles, doubles)),
        ("set_state", function(none, c_void_p, c_double, c_double, doubles, doubles)),
        ("set_h", function(none, c_void_p, c_double, c_double)),
        ("set_parameters", function(none, c_void_p, doubles, doubles))]


def load(path):
    library = ctypes.CDLL(path)
    library.hamgen_plugin_entry.restype = POINTER(Plugin)
    table = library.hamgen_plugin_entry()
    if not table or table.contents.version != 5:
        sys.exit(f"{path}: no plugin of version 5")
    return table.contents


def names(quantities):
    """q1, q2, x[1], x[2], ...: one for each value."""
    result = []
    for quantity in quantities:  # ends with a name that is null
        if not quantity.name:
            return result
        name = quantity.name.decode()
        result += ([f"{name}[{quantity.first + i}]" for i in range(quantity.count)]
                   if quantity.is_array else [name])


kepler = load("./kepler.so")
variables = names(kepler.variable_list)
parameters = (c_double * max(1, kepler.parameter_count))()
kepler.default_parameters(parameters, None)
state = (c_double * len(variables))(0.4, 0.0, 0.0, 2.0)
run = kepler.create(parameters, None, 2 * math.pi / 1000, 0.0, state, None)
report = Report()
for quarter in range(4):
    kepler.advance(run, 250, 1, byref(report))
    if report.status != 0:
        sys.exit(f"status {report.status} after {report.steps_done} steps")
    kepler.get_state(run, state, None)
    shown = ", ".join(f"{name} = {value:9.6f}" for name, value in zip(variables, state))
    print(f"t = {kepler.get_time(run, None):.4f}: {shown}")
values = (c_double * kepler.invariant_count)()
kepler.invariants(parameters, None, state, None, values, None)
print(", ".join(f"{name} = {value:.9f}" for name, value in zip(names(kepler.invariant_list), values)))
kepler.destroy(run)

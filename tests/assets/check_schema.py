"""check_schema.py SCHEMA FILE...: validates JSON files. Supports only part of JSON Schema and
fails if SCHEMA uses more. Needs only Python's standard library."""
import json
import sys

KNOWN = {"$schema", "$defs", "$ref", "title", "description", "type", "properties", "required", "additionalProperties",
         "items", "minItems", "maxItems", "minimum", "exclusiveMinimum", "maximum", "minLength", "maxLength", "const",
         "enum", "oneOf"}
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}


def is_type(value, name):
    if name in TYPES:
        return isinstance(value, TYPES[name])
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number and (name == "number" or float(value).is_integer())


def faults(value, schema, root, at):
    unknown = set(schema) - KNOWN
    if unknown:
        raise ValueError("the schema uses %s, which this does not know" % ", ".join(sorted(unknown)))
    if "$ref" in schema:
        return faults(value, root["$defs"][schema["$ref"].rsplit("/", 1)[1]], root, at)
    found = []
    if "type" in schema and not is_type(value, schema["type"]):
        return ["%s: no %s" % (at, schema["type"])]
    if "const" in schema and value != schema["const"]:
        found.append("%s: not %r" % (at, schema["const"]))
    if "enum" in schema and value not in schema["enum"]:
        found.append("%s: none of %r" % (at, schema["enum"]))
    for word, holds in (("minimum", lambda limit: value >= limit), ("maximum", lambda limit: value <= limit),
                        ("exclusiveMinimum", lambda limit: value > limit), ("minItems", lambda limit: len(value) >= limit),
                        ("maxItems", lambda limit: len(value) <= limit), ("minLength", lambda limit: len(value) >= limit),
                        ("maxLength", lambda limit: len(value) <= limit)):
        if word in schema and not holds(schema[word]):
            found.append("%s: breaks %s %r" % (at, word, schema[word]))
    if "items" in schema:
        for index, item in enumerate(value):
            found += faults(item, schema["items"], root, "%s/%d" % (at, index))
    for name in schema.get("required", []):
        if name not in value:
            found.append("%s: no %s" % (at, name))
    properties = schema.get("properties", {})
    if isinstance(value, dict):
        for name, item in value.items():
            if name in properties:
                found += faults(item, properties[name], root, "%s/%s" % (at, name))
            elif schema.get("additionalProperties") is False:
                found.append("%s: unknown %s" % (at, name))
    if "oneOf" in schema:
        fitting = [one for one in schema["oneOf"] if not faults(value, one, root, at)]
        if len(fitting) != 1:
            found.append("%s: fits %d of the alternatives" % (at, len(fitting)))
    return found


def main(schema_path, paths):
    with open(schema_path) as file:
        schema = json.load(file)
    bad = 0
    for path in paths:
        with open(path) as file:
            found = faults(json.load(file), schema, schema, "")
        for line in found[:20]:
            print("%s: %s" % (path, line))
        bad += bool(found)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])

"""omega and x(t) of `derive ... --at ... --format json`, x(t) of `impact`: python3 read_json.py FILE T... (slow: read_slow_json.py)"""
import json, math, sys

def value(polynomial, values):
    return sum(t["value"] * math.prod(values[s] ** n for s, n in t["monomial"].items()) for t in polynomial["terms"])

def frequency(solution):
    values, omega = solution["verification"]["values"], solution["verification"]["frequency"]
    if solution["frequency_squared"]:  # stands before `frequency`
        return math.sqrt(value(solution["frequency_squared"], values))
    if solution["relation"]:  # zero at omega: Newton's steps stay there
        relation, step = lambda w: value(solution["relation"], values | {"omega": w}), 1e-5 * omega
        for _ in range(3):
            omega -= 2 * step * relation(omega) / (relation(omega + step) - relation(omega - step))
    elif solution["frequency"]:
        omega = value(solution["frequency"], values)
    return omega  # of a special function, an integral or a balance as it was computed

def motion(solution, t):
    judged = solution["verification"]
    theta = frequency(solution) * t + judged["phase"]
    number = lambda part: value(part, judged["values"]) if isinstance(part, dict) else part
    symbols = [] if judged["phase"] else solution["displacement"]["harmonics"]
    waves = [(h["harmonic"] * theta, h) for h in symbols or judged["motion"]]
    return sum(number(h["cos"]) * math.cos(angle) + number(h["sin"]) * math.sin(angle) for angle, h in waves)

def phase(p, t):  # of `impact`: the clock of a phase is where its formula counts from
    d, s = p["displacement"], t - p["clock"]
    waves = [(h["harmonic"] * d["frequency"] * s, h) for h in d["harmonics"]]
    wave = sum(h["cos"] * math.cos(angle) + h["sin"] * math.sin(angle) for angle, h in waves)
    return d["centre"] + d["parabola"] * s * (d["duration"] - s) + wave

document, times = json.load(open(sys.argv[1])), [float(t) for t in sys.argv[2:]]
if document["schema"] == "lindstedt/solution/1":
    if document["response"] or document["verification"]["followed"]:
        sys.exit("its amplitude changes, or a drive holds it: read_slow_json.py")
    print(json.dumps([frequency(document)] + [motion(document, t) for t in times]))
for p in sum((document.get(key, []) for key in ("phases", "energy_phases", "derived_phases")), []):
    print(json.dumps([p["name"]] + [phase(p, t) for t in times if p["start"] <= t <= p["end"]]))

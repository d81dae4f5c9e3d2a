"""x(t) from the JSON of `derive ... --at ...` where the amplitude changes or a drive holds it: python3 read_slow_json.py FILE T..."""
import json, math, sys

def text(formula, values):  # slow equations are text; the functions of theirs that Python has not are J0, J1 and sgn
    mean = lambda n, x: sum(math.cos(n * q * math.pi / 64 - x * math.sin(q * math.pi / 64)) for q in range(128)) / 128
    own = {"J0": lambda x: mean(0, x), "J1": lambda x: mean(1, x), "sgn": lambda x: math.copysign(1, x), "abs": abs}
    return eval(formula.replace("^", "**"), vars(math) | own | values)

def slow(solution, t, steps=500):  # a and psi from where they start, by Runge-Kutta
    modulation, values, h = solution["modulation"], solution["verification"]["values"], t / steps
    at = lambda now: values | dict(zip((modulation["amplitude"], modulation["phase"]), now))
    now = [text(modulation["release"][key], values) for key in ("amplitude", "phase")]
    for _ in range(steps):
        rates = [[0, 0]]
        for part in (0, h / 2, h / 2, h):
            place = at(x + part * rate for x, rate in zip(now, rates[-1]))
            rates.append([text(modulation[key], place) for key in ("amplitude_rate", "phase_rate")])
        now = [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(now, *rates[1:])]
    return at(now)

def motion(solution, t):
    response, psi = solution["response"], solution["modulation"]["phase"]
    if response:  # driven: the stable steady motion that is judged
        state = next(state for state in solution["verification"]["steady_states"] if state["stable"])
        own = {"t": t, solution["modulation"]["amplitude"]: state["amplitude"], psi: state["phase"]}
        return text(response["motion"], solution["verification"]["values"] | own)
    values = slow(solution, t)
    value = lambda part: sum(c["value"] * math.prod(values[s] ** n for s, n in c["monomial"].items()) for c in part["terms"])
    angles = [(h["harmonic"] * values[psi], h) for h in solution["displacement"]["harmonics"]]
    return sum(value(h["cos"]) * math.cos(angle) + value(h["sin"]) * math.sin(angle) for angle, h in angles)

solution, times = json.load(open(sys.argv[1])), [float(t) for t in sys.argv[2:]]
print(json.dumps([motion(solution, t) for t in times]))

"""The documents as frozen dataclasses, one module a kind.

Made by `python/generate.py` from the JSON schemas: change those.
"""

#: The module and the classes of each kind, by what stands under `schema`.
KINDS: dict[str, tuple[str, tuple[str, ...]]] = {
    "lindstedt/absorber/1": ("absorber", ("Absorber",)),
    "lindstedt/audit/1": ("audit", ("Audit",)),
    "lindstedt/catalog/1": ("catalog", ("Catalog",)),
    "lindstedt/certificate-range/1": ("certificate_range", ("CertificateRange",)),
    "lindstedt/certificate/1": ("certificate", ("CertificateDocument", "DampedCertificateDocument", "ModeCertificateDocument", "CoupledCertificateDocument", "LawCertificateDocument", "OrbitCertificateDocument",)),
    "lindstedt/comparison/1": ("comparison", ("Comparison",)),
    "lindstedt/fit/1": ("fit", ("Fit",)),
    "lindstedt/friction/1": ("friction", ("Friction",)),
    "lindstedt/impact-certificate/1": ("impact_certificate", ("ImpactCertificate",)),
    "lindstedt/impact-comparison/1": ("impact_comparison", ("ImpactComparison",)),
    "lindstedt/impact/1": ("impact", ("Impact",)),
    "lindstedt/lagrangian/1": ("lagrangian", ("Lagrangian",)),
    "lindstedt/materials/1": ("materials", ("Materials",)),
    "lindstedt/modes/1": ("modes", ("Modes",)),
    "lindstedt/motion-sweep/1": ("motion_sweep", ("MotionSweep",)),
    "lindstedt/motion/1": ("motion", ("Motion",)),
    "lindstedt/one-harmonic/1": ("one_harmonic", ("OneHarmonic",)),
    "lindstedt/optimization/1": ("optimization", ("Optimization",)),
    "lindstedt/orbits/1": ("orbits", ("Orbits",)),
    "lindstedt/point/1": ("point", ("Point",)),
    "lindstedt/primary-sweep/1": ("primary_sweep", ("PrimarySweep",)),
    "lindstedt/primary/1": ("primary", ("Primary",)),
    "lindstedt/response/1": ("response", ("Response",)),
    "lindstedt/shortest/1": ("shortest", ("Shortest",)),
    "lindstedt/simulation/1": ("simulation", ("Simulation",)),
    "lindstedt/slow-equations/1": ("slow_equations", ("SlowEquations",)),
    "lindstedt/solution/1": ("solution", ("Solution",)),
    "lindstedt/stability/1": ("stability", ("Stability",)),
    "lindstedt/study/1": ("study", ("Study",)),
    "lindstedt/sweep/1": ("sweep", ("Sweep",)),
}

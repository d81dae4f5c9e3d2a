"""Proofs of motions."""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext

from .documents.certificate import CertificateDocument


class Certificate(CertificateDocument):
    """Numbers from which a motion is proved; `lindstedt.check` proves it again from its file.

    >>> import lindstedt as ls
    >>> certificate = ls.certify("pendulum", A="3/2")
    >>> certificate.passed, round(certificate.omega, 12)
    (True, 0.86060834668)
    >>> low, high = certificate.omega_bounds
    >>> high - low < 1e-30
    True
    """

    @property
    def omega(self) -> float:
        """The angular frequency of the motion that is proved, in radians per unit of time."""
        low, _ = self.omega_bounds
        return float(low)

    @property
    def omega_bounds(self) -> tuple[Decimal, Decimal]:
        """Bounds of the angular frequency: 1/omega^2 is within claim_r / 2^sigma_log2 of mu."""
        with localcontext() as context:
            context.prec = 80
            radius = Decimal(self.claim_r) / Decimal(2) ** int(self.sigma_log2)
            middle = Decimal(self.mu) / Decimal(2) ** self.bits
            context.rounding = ROUND_FLOOR
            low = (1 / (middle + radius)).sqrt()
            context.rounding = ROUND_CEILING
            high = (1 / (middle - radius)).sqrt()
            # The root rounds to nearest: one more digit at each end.
            step = Decimal(10) ** -75
            return low - step, high + step

"""sRGB -> CIELAB (D65) and the CIEDE2000 difference with kL = kC = kH = 1.

Sharma, Wu, Dalal: The CIEDE2000 Color-Difference Formula, Color Research and Application 30(1), 2005; equation numbers are theirs.
"""
import numpy as np

XYZ_FROM_RGB = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
WHITE_D65 = XYZ_FROM_RGB.sum(axis=1)  # (0.95047, 1, 1.08883): white is exactly L* = 100, a* = b* = 0
OPPOSITE = 180 + 1e-9  # degrees; exactly opposite hues (Sharma's pairs 10 and 14) stay on one side of the jump whatever the rounding


def lab_from_srgb(rgb):
    """sRGB in [0,1] -> linear (0.04045, 12.92, 1.055, 2.4) -> XYZ -> L*, a*, b*."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    t = linear @ XYZ_FROM_RGB.T / WHITE_D65
    f = np.where(t > 216 / 24389, np.cbrt(t), (24389 / 27 * t + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def hue_degrees(a, b):
    """atan2(b, a) in [0, 360), 0 for a = b = 0."""
    return np.degrees(np.arctan2(b, a)) % 360.0


def mean_hue(h1, h2, gray):
    """Eq. 14: the mean of two hue angles across the shorter arc; their sum when either color is gray."""
    total = h1 + h2
    across = np.where(total < 360, (total + 360) / 2, (total - 360) / 2)
    return np.where(gray, total, np.where(np.abs(h1 - h2) <= OPPOSITE, total / 2, across))


def hue_difference(h1, h2, gray):
    """Eq. 10: h2 - h1 in [-180, 180], 0 when either color is gray."""
    d = h2 - h1
    return np.where(gray, 0.0, np.where(d > OPPOSITE, d - 360, np.where(d < -OPPOSITE, d + 360, d)))


def ciede2000(lab1, lab2):
    """Eqs. 2-22."""
    (l1, a1, b1), (l2, a2, b2) = np.moveaxis(lab1, -1, 0), np.moveaxis(lab2, -1, 0)
    c7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 0.5 * (1 - np.sqrt(c7 / (c7 + 25.0**7)))
    a1, a2 = (1 + g) * a1, (1 + g) * a2
    c1, c2, h1, h2 = np.hypot(a1, b1), np.hypot(a2, b2), hue_degrees(a1, b1), hue_degrees(a2, b2)
    gray = c1 * c2 == 0
    d_l, d_c = l2 - l1, c2 - c1
    d_h = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(hue_difference(h1, h2, gray) / 2))
    l_mean, c_mean, h_mean = (l1 + l2) / 2, (c1 + c2) / 2, mean_hue(h1, h2, gray)
    cosine = lambda factor, shift: np.cos(np.radians(factor * h_mean + shift))
    t = 1 - 0.17 * cosine(1, -30) + 0.24 * cosine(2, 0) + 0.32 * cosine(3, 6) - 0.20 * cosine(4, -63)
    s_l = 1 + 0.015 * (l_mean - 50) ** 2 / np.sqrt(20 + (l_mean - 50) ** 2)
    s_c, s_h = 1 + 0.045 * c_mean, 1 + 0.015 * c_mean * t
    r_c = 2 * np.sqrt(c_mean**7 / (c_mean**7 + 25.0**7))
    r_t = -np.sin(np.radians(60 * np.exp(-(((h_mean - 275) / 25) ** 2)))) * r_c
    return np.sqrt((d_l / s_l) ** 2 + (d_c / s_c) ** 2 + (d_h / s_h) ** 2 + r_t * (d_c / s_c) * (d_h / s_h))

"""The desktop application: the window, one page per step. Composes widgets; computes nothing."""

"""`python -m atomsim` is `atomsim`."""

from atomsim.cli import main

main()

"""Helpers that tests share; knows no test."""

"""The record of a survey, with the reviewed proposals, and the types of all records of recovery."""

"""When the arm is where: limits, profiles, schedules, what is passed on the way."""

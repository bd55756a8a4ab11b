"""What `lietool bench` measures: accuracy, time, and the tables of Kaji and Ochiai."""
